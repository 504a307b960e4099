// What the reading of values shares: where mistakes go, what names mean, which files were read.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "field/base/id.h"
#include "field/base/result.h"
#include "field/description/field_node.h"
#include "renderer/scene/definitions.h"
#include "renderer/scene/document.h"
#include "renderer/scene/input_files.h"
#include "renderer/scene/source_cache.h"

namespace marrow {

class Reader {
 public:
  Reader(SourceCache& sources_, InputFiles& files_, std::filesystem::path folder)
      : sources(sources_), files(files_), folder_(std::move(folder)) {}

  SourceCache& sources;
  InputFiles& files;
  Diagnostics problems, warnings;

  static constexpr std::size_t max_nodes = 10'000'000;

  /// The value that is being read, as messages name it: `radius`, `points[2]`.
  std::string subject = "the scene";

  std::vector<std::string> materials;  ///< MaterialId indexes this
  Definitions definitions;
  FieldDescription* field = nullptr;  ///< the tree that nodes are added to
  /// What `field` holds already of the library of definitions, by index there; never walked.
  std::unordered_map<std::size_t, FieldNodeId> placed;
  std::size_t nodes_left = max_nodes;  ///< of all fields together

  void error(const Place&, std::string message, std::string hint = {}, std::size_t length = 1);
  /// "`radius` must be a number above 0, found -1"; returns nothing for convenience. Silent where the value is broken.
  std::nullopt_t wrong(const Value&, const std::string& words, std::string hint = {});
  /// A name that is none of `known`: "unknown material `glod`", and what was meant.
  std::nullopt_t unknown(const std::string& what, const std::string& name, const Place&,
                         const std::vector<std::string>& known);
  /// A word that the format has and this version cannot render.
  std::nullopt_t not_yet(const std::string& name, const Place&);

  /// Takes `count` from nodes_left, or reports and returns false.
  bool spend_nodes(std::size_t count, const Place&);

  /// A file that the scene names at `place`, relative to the file in which it is named.
  std::filesystem::path resolve(const std::string& name, const Place&) const;
  std::optional<InputFile> open(const std::filesystem::path&, const Place&);
  /// Adds the diagnostics of a data file, keeping its text so that they can be shown.
  void report_file(const std::filesystem::path&, std::string text, const Diagnostics&);

  /// Skeletons by file and parameters: a file that is placed many times is held once.
  std::map<std::string, SharedSkeletonGraph> skeletons;

 private:
  std::filesystem::path folder_;
  bool said_too_large_ = false;
};

/// The name of item `i` of a list: `points` becomes `points[2]`.
std::string item_of(const std::string& list, std::size_t i);

/// Names the value that is read while it lives: `subject` inside a key, or an item of a list.
class Subject {
 public:
  Subject(Reader& reader, std::string name) : reader_(reader), outer_(std::move(reader.subject)) {
    reader.subject = std::move(name);
  }
  ~Subject() { reader_.subject = std::move(outer_); }
  Subject(const Subject&) = delete;
  Subject& operator=(const Subject&) = delete;

 private:
  Reader& reader_;
  std::string outer_;
};

}  // namespace marrow
