#include "renderer/output/display.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <variant>

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "renderer/output/embedded_ocio.h"

namespace ocio = OCIO_NAMESPACE;

namespace marrow {

// One after the other: into the configuration's scene_linear when it does not know our space, then to the display.
struct Display::Steps {
  std::vector<ocio::ConstCPUProcessorRcPtr> processors;
};

namespace {

ocio::ConstConfigRcPtr embedded_config() {
  std::istringstream text{std::string(embedded_ocio())};
  return ocio::Config::CreateFromStream(text);
}

struct Source {
  ocio::ConstConfigRcPtr config;
  std::string name;
};

Source find_config(const std::optional<std::filesystem::path>& ocio_file) {
  if (ocio_file) return {ocio::Config::CreateFromFile(ocio_file->c_str()), ocio_file->string()};
  if (const char* path = std::getenv("OCIO"); path && *path) return {ocio::Config::CreateFromEnv(), path};
  return {embedded_config(), "embedded"};
}

std::string list(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

std::vector<std::string> display_names(const ocio::Config& config) {
  std::vector<std::string> names;
  for (int i = 0; i < config.getNumDisplays(); ++i) names.emplace_back(config.getDisplay(i));
  return names;
}

std::vector<std::string> view_names(const ocio::Config& config, const std::string& display) {
  std::vector<std::string> names;
  for (int i = 0; i < config.getNumViews(display.c_str()); ++i) names.emplace_back(config.getView(display.c_str(), i));
  return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

Diagnostic unknown(const std::string& what, const std::string& name, const std::vector<std::string>& known,
                   const std::string& file) {
  return with_hint(failure(fmt::format("unknown {} \"{}\"", what, name), file),
                   fmt::format("known {}s: {}", what, list(known)));
}

// Exact rather than fast: the shortcuts for log and pow cost more accuracy than a 16-bit file can hide.
ocio::ConstCPUProcessorRcPtr compile(const ocio::ConstProcessorRcPtr& processor) {
  return processor->getOptimizedCPUProcessor(ocio::BIT_DEPTH_F32, ocio::BIT_DEPTH_F32, ocio::OPTIMIZATION_LOSSLESS);
}

std::vector<ocio::ConstCPUProcessorRcPtr> make_steps(const ocio::ConstConfigRcPtr& config, const std::string& display,
                                                     const std::string& view, const std::string& working_space) {
  std::vector<ocio::ConstCPUProcessorRcPtr> steps;
  std::string from = working_space;
  if (!config->getColorSpace(working_space.c_str())) {
    from = ocio::ROLE_SCENE_LINEAR;
    if (config->hasRole("aces_interchange"))
      steps.push_back(compile(ocio::Config::GetProcessorFromConfigs(
          embedded_config(), working_space.c_str(), "aces_interchange", config, from.c_str(), "aces_interchange")));
  }
  const auto transform = ocio::DisplayViewTransform::Create();
  transform->setSrc(from.c_str());
  transform->setDisplay(display.c_str());
  transform->setView(view.c_str());
  steps.push_back(compile(config->getProcessor(transform)));
  return steps;
}

std::string describe(const ocio::Config& config, const std::string& display, const std::string& view) {
  return fmt::format("{} [{}] {} / {}", config.getName(), config.getCacheID(), display, view);
}

const FloatRow* float_channel(const PictureRows& picture, const std::string& name) {
  for (const ChannelRows& c : picture.channels)
    if (c.name == name) return std::get_if<FloatRow>(&c.fill);
  return nullptr;
}

}  // namespace

Result<Display> Display::open(const std::optional<std::filesystem::path>& ocio_file, const std::string& display,
                              const std::string& view, const std::string& working_space) {
  try {
    const auto [config, file] = find_config(ocio_file);
    if (!config->hasRole(ocio::ROLE_SCENE_LINEAR))
      return failure("this OpenColorIO configuration has no role scene_linear", file);
    if (!embedded_config()->getColorSpace(working_space.c_str()))
      return failure("unknown working space \"" + working_space + "\"");

    const std::string screen = display.empty() ? config->getDefaultDisplay() : display;
    if (!contains(display_names(*config), screen)) return unknown("display", screen, display_names(*config), file);
    std::vector<std::string> views = view_names(*config, screen);
    const std::string chosen = view.empty() ? config->getDefaultView(screen.c_str()) : view;
    if (!contains(views, chosen)) return unknown("view", chosen, views, file);

    auto steps = std::make_shared<const Steps>(Steps{make_steps(config, screen, chosen, working_space)});
    return Display(std::move(steps), describe(*config, screen, chosen), chosen, std::move(views));
  } catch (const ocio::Exception& e) {
    return failure(std::string("OpenColorIO: ") + e.what(), ocio_file ? ocio_file->string() : "");
  }
}

void Display::apply(std::span<float> rgb) const {
  constexpr std::size_t pixels_per_task = 4096;
  const tbb::blocked_range<std::size_t> pixels(0, rgb.size() / 3, pixels_per_task);
  tbb::parallel_for(pixels, [&](const tbb::blocked_range<std::size_t>& r) {
    ocio::PackedImageDesc part(rgb.data() + 3 * r.begin(), static_cast<long>(r.size()), 1, 3);
    for (const auto& processor : steps_->processors) processor->apply(part);
  });
}

Result<RgbImage> Display::apply(const PictureRows& picture) const {
  RgbImage image(picture.data.width(), picture.data.height());
  const auto width = static_cast<std::size_t>(picture.data.width());
  const char* const names[] = {"R", "G", "B"};
  for (std::size_t k = 0; k < 3; ++k) {
    const FloatRow* channel = float_channel(picture, names[k]);
    if (!channel) return failure(fmt::format("the picture has no channel {} to display", names[k]));
    tbb::parallel_for(0, picture.data.height(), [&](int line) {
      std::vector<float> row(width);
      (*channel)(picture.data.y0 + line, row);
      float* to = image.samples.data() + 3 * width * static_cast<std::size_t>(line) + k;
      for (std::size_t i = 0; i < width; ++i) to[3 * i] = row[i];
    });
  }
  apply(image.samples);
  return image;
}

}  // namespace marrow
