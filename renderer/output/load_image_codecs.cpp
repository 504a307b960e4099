// Finds and loads the module of image codecs.
#include <filesystem>

#include <dlfcn.h>

#include "renderer/output/image_codecs.h"

namespace marrow {
namespace {

namespace fs = std::filesystem;

void* opened() {
  std::error_code error;
  const fs::path built = MARROW_IMAGE_CODECS, beside = fs::read_symlink("/proc/self/exe", error).parent_path();
  if (void* module = dlopen((beside / built.filename()).c_str(), RTLD_NOW | RTLD_LOCAL)) return module;
  return dlopen(built.c_str(), RTLD_NOW | RTLD_LOCAL);
}

Result<const ImageCodecs*> load() {
  void* module = opened();
  if (module == nullptr) return failure(std::string("cannot load the image codecs: ") + dlerror());
  using Entry = const ImageCodecs* (*)();
  const auto entry = reinterpret_cast<Entry>(dlsym(module, "marrow_image_codecs"));
  if (entry == nullptr) return failure(std::string("not a module of image codecs: ") + dlerror());
  return entry();
}

}  // namespace

Result<const ImageCodecs*> image_codecs() {
  static const Result<const ImageCodecs*> loaded = load();
  return loaded;
}

}  // namespace marrow
