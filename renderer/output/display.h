// From scene-linear light to the colours of a display, by OpenColorIO.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "field/base/result.h"
#include "renderer/output/picture.h"
#include "renderer/output/rgb_image.h"

namespace marrow {

/// A configuration, a display and a view of it, ready to apply.
class Display {
 public:
  /// The configuration is `ocio_file` (--ocio), else the file that $OCIO names, else the one inside the program.
  /// An empty `display` or `view` means the configuration's default. `working_space` says what the light is measured
  /// in: lin_rec709_scene or lin_ap1_scene; a configuration that does not know that name is reached through its
  /// aces_interchange role, and one without that role is trusted to mean it by scene_linear.
  /// Errors: an unreadable configuration, no role scene_linear, an unknown display or view (the message lists them).
  static Result<Display> open(const std::optional<std::filesystem::path>& ocio_file = {},
                              const std::string& display = {}, const std::string& view = {},
                              const std::string& working_space = "lin_rec709_scene");

  /// In place on triples of red, green, blue. May be called by several threads at once.
  void apply(std::span<float> rgb) const;
  /// Display-encoded R, G, B of the picture's data window: opaque, over the background as it was rendered.
  /// Error: the picture has no float channels R, G, B.
  Result<RgbImage> apply(const PictureRows&) const;

  /// Configuration, its cache id, display and view in one line, for metadata.
  const std::string& name() const { return name_; }
  const std::string& view() const { return view_; }
  /// The views of this display.
  const std::vector<std::string>& views() const { return views_; }

 private:
  struct Steps;
  Display(std::shared_ptr<const Steps> steps, std::string name, std::string view, std::vector<std::string> views)
      : steps_(std::move(steps)), name_(std::move(name)), view_(std::move(view)), views_(std::move(views)) {}

  std::shared_ptr<const Steps> steps_;
  std::string name_, view_;
  std::vector<std::string> views_;
};

}  // namespace marrow
