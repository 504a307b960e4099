#include "tests/golden/golden_run.h"

#include <cerrno>
#include <cstring>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include "renderer/output/atomic_file.h"
#include "renderer/output/exr.h"

extern char** environ;

namespace marrow {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> command(const Expectation& e, const GoldenSetup& setup, const fs::path& output) {
  std::vector<std::string> words = {setup.program.string(), "render", (setup.repository / e.scene).string(), "-o",
                                    output.string(),        "--quiet"};
  for (const std::string& o : e.overrides) words.insert(words.end(), {"-D", o});
  words.insert(words.end(), e.arguments.begin(), e.arguments.end());
  return words;
}

Status run(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& w : words) arguments.push_back(const_cast<char*>(w.c_str()));  // posix_spawn's old promise
  arguments.push_back(nullptr);
  const std::string line = fmt::format("{}", fmt::join(words, " "));
  pid_t child = 0;
  if (const int error = posix_spawn(&child, arguments[0], nullptr, nullptr, arguments.data(), environ); error != 0)
    return failure(fmt::format("cannot start {}: {}", line, std::strerror(error)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return failure("cannot wait for " + line);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return failure(fmt::format("status {} of {}", status, line));
  return Done{};
}

Result<Picture> render_scene(const Expectation& e, const GoldenSetup& setup) {
  const fs::path folder = setup.work / e.name, output = folder / "got.exr";
  std::error_code error;
  fs::remove_all(folder, error);
  fs::create_directories(folder, error);
  if (error) return failure("cannot make the folder: " + error.message(), folder.string());
  if (Status done = run(command(e, setup, output)); !done) return done.why();
  return read_exr(output);
}

Status leave_evidence(const Expectation& e, const GoldenSetup& setup, const Picture& want, const Comparison& comparison,
                      const std::string& text) {
  const fs::path folder = setup.work / e.name;
  if (Status done = write_exr(folder / "want.exr", want); !done) return done;
  if (Status done = write_exr(folder / "difference.exr", comparison.difference); !done) return done;
  return write_file_atomically(folder / "report.txt", std::as_bytes(std::span(text)));
}

}  // namespace

Result<std::string> check_golden(const Expectation& e, const GoldenSetup& setup) {
  const Result<Picture> want = read_exr(e.reference);
  if (!want) return want.why();
  const Result<Picture> got = render_scene(e, setup);
  if (!got) return got.why();
  const Result<Comparison> comparison = compare(*got, *want, e.channels, e.thresholds);
  if (!comparison) return comparison.why();
  const std::string text = e.name + ": " + e.why + "\n" + report(*comparison, e.thresholds);
  if (comparison->passed()) return text;

  if (Status left = leave_evidence(e, setup, *want, *comparison, text); !left) return left.why();
  Diagnostic d = failure("differs from its reference\n" + text, e.reference.string());
  d.hint = "see got.exr, want.exr, difference.exr and report.txt in " + (setup.work / e.name).string();
  return d;
}

Status update_golden(const Expectation& e, const GoldenSetup& setup) {
  Result<Picture> got = render_scene(e, setup);
  if (!got) return got.why();
  Picture reference{.display = got->display,
                    .data = got->data,
                    .channels = select_channels(*got, e.channels),
                    .metadata = {{"comments", e.why}}};
  if (reference.channels.empty()) return failure("the picture has none of the channels of " + e.name);
  return write_exr(e.reference, reference);
}

}  // namespace marrow
