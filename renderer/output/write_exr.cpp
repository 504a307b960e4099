// Writing, by OpenEXR's C interface: parts of a picture are made and compressed by any threads and put together then.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include <Imath/half.h>
#include <OpenEXR/openexr.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "field/base/overloaded.h"
#include "renderer/output/atomic_file.h"
#include "renderer/output/exr.h"
#include "renderer/output/exr_header.h"
#include "renderer/output/exr_zip.h"

namespace marrow {
namespace {

static_assert(std::endian::native == std::endian::little, "samples go to the file as they are in memory");

constexpr int part = 0;  // the only one

bool is_color(std::string_view name) {
  return name == "R" || name == "G" || name == "B" || name == "A" || name.starts_with("albedo.");
}

Status check(const PictureRows& picture) {
  if (picture.display.width() <= 0 || picture.display.height() <= 0 || picture.data.width() <= 0 ||
      picture.data.height() <= 0)
    return failure("the picture has no pixels");
  if (picture.channels.empty()) return failure("the picture has no channels");
  return Done{};
}

// ---- header ----

std::optional<exr_attr_chromaticities_t> chromaticities(const HeaderEntries& entries) {
  const auto* id = std::get_if<std::string>(&entries.at("colorInteropID"));
  if (!id) return {};
  if (*id == "lin_rec709_scene")  // Rec. ITU-R BT.709-6, item 1.3 and 1.4
    return exr_attr_chromaticities_t{.64f, .33f, .30f, .60f, .15f, .06f, .3127f, .3290f};
  if (*id == "lin_ap1_scene")  // Academy S-2014-004, ACEScg
    return exr_attr_chromaticities_t{.713f, .293f, .165f, .830f, .128f, .044f, .32168f, .33767f};
  return {};
}

// ---- channels ----

struct WrittenChannel {
  const ChannelRows* rows;
  exr_pixel_type_t type;
  std::size_t bytes() const { return type == EXR_PIXEL_HALF ? 2 : 4; }
};

exr_pixel_type_t type_of(const ChannelRows& channel, ExrColor color) {
  if (std::holds_alternative<WholeRow>(channel.fill)) return EXR_PIXEL_UINT;
  return color == ExrColor::Half && is_color(channel.name) ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
}

// By name, the order of EXR.
Result<std::vector<WrittenChannel>> written_channels(const PictureRows& picture, ExrColor color) {
  std::vector<WrittenChannel> channels;
  for (const ChannelRows& c : picture.channels) channels.push_back({&c, type_of(c, color)});
  std::ranges::sort(channels, {}, [](const WrittenChannel& c) { return std::string_view(c.rows->name); });
  const auto same = [](const WrittenChannel& a, const WrittenChannel& b) { return a.rows->name == b.rows->name; };
  if (const auto twice = std::ranges::adjacent_find(channels, same); twice != channels.end())
    return failure("channel " + twice->rows->name + " occurs twice");
  return channels;
}

// ---- the file ----

void require(exr_result_t result) {
  if (result != EXR_ERR_SUCCESS) throw std::runtime_error(exr_get_error_code_as_string(result));
}

exr_attr_box2i_t box_of(const PixelWindow& w) {  // EXR's windows include their last pixel
  return {{{w.x0, w.y0}}, {{w.x1 - 1, w.y1 - 1}}};
}

// A file in memory: nothing can fail there but the memory itself, and the disk is the business of
// write_file_atomically.
class MemoryFile {
 public:
  MemoryFile() {
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {};  // `require` tells
    init.user_data = &bytes_;
    init.write_fn = write;
    require(exr_start_write(&context_, "memory", EXR_WRITE_FILE_DIRECTLY, &init));
  }
  ~MemoryFile() {
    if (context_) exr_finish(&context_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  exr_context_t context() const { return context_; }
  std::span<const std::byte> bytes() const { return bytes_; }
  void reserve(std::size_t more) { bytes_.reserve(bytes_.size() + more); }
  std::vector<std::byte> finish() {
    require(exr_finish(&context_));  // writes the table of line offsets
    return std::move(bytes_);
  }

 private:
  static std::int64_t write(exr_const_context_t, void* file, const void* data, std::uint64_t count, std::uint64_t at,
                            exr_stream_error_func_ptr_t) noexcept {
    auto& bytes = *static_cast<std::vector<std::byte>*>(file);
    if (bytes.size() < at + count) bytes.resize(at + count);
    std::memcpy(bytes.data() + at, data, count);
    return static_cast<std::int64_t>(count);
  }

  exr_context_t context_ = nullptr;
  std::vector<std::byte> bytes_;
};

void write_header(exr_context_t file, const PictureRows& picture, const std::vector<WrittenChannel>& channels,
                  const HeaderEntries& entries) {
  require(exr_add_part(file, nullptr, EXR_STORAGE_SCANLINE, nullptr));
  require(exr_set_longname_support(file, 1));
  const exr_attr_box2i_t display = box_of(picture.display), data = box_of(picture.data);
  const exr_attr_v2f_t center{};
  require(exr_initialize_required_attr(file, part, &display, &data, 1, &center, 1, EXR_LINEORDER_INCREASING_Y,
                                       EXR_COMPRESSION_ZIP));
  for (const WrittenChannel& c : channels)
    require(exr_add_channel(file, part, c.rows->name.c_str(), c.type, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1));
  for (const auto& [name, value] : entries)
    std::visit(Overloaded{
                   [&](const std::string& s) { require(exr_attr_set_string(file, part, name.c_str(), s.c_str())); },
                   [&](int i) { require(exr_attr_set_int(file, part, name.c_str(), i)); },
                   [&](double d) { require(exr_attr_set_double(file, part, name.c_str(), d)); },
               },
               value);
  require(exr_attr_set_float(file, part, "utcOffset", 0));
  if (const auto known = chromaticities(entries))
    require(exr_attr_set_chromaticities(file, part, "chromaticities", &*known));
  require(exr_write_header(file));
}

// ---- pixels ----

// Makes and compresses one chunk of rows after the other; each thread has its own.
class ChunkEncoder {
 public:
  ChunkEncoder(const std::vector<WrittenChannel>& channels, const PixelWindow& data)
      : channels_(channels), data_(data), floats_(width(data)), whole_(width(data)), halves_(width(data)) {}

  // The chunk whose first row is y, as it stands in the file: row by row, and in a row channel by channel.
  std::vector<std::byte> encode(int y, int rows) {
    samples_.clear();
    for (const int end = std::min(y + rows, data_.y1); y < end; ++y)
      for (const WrittenChannel& channel : channels_) {
        const std::span<const std::byte> row = row_of(channel, y);
        samples_.insert(samples_.end(), row.begin(), row.end());
      }
    return zip_.compress(samples_);
  }

 private:
  static std::size_t width(const PixelWindow& data) { return static_cast<std::size_t>(data.width()); }

  std::span<const std::byte> row_of(const WrittenChannel& channel, int y) {
    if (const auto* fill = std::get_if<WholeRow>(&channel.rows->fill)) {
      (*fill)(y, whole_);
      return std::as_bytes(std::span(whole_));
    }
    std::get<FloatRow>(channel.rows->fill)(y, floats_);
    if (channel.type == EXR_PIXEL_FLOAT) return std::as_bytes(std::span(floats_));
    std::ranges::transform(floats_, halves_.begin(), [](float v) {
      return Imath::half(v > HALF_MAX ? float(HALF_MAX) : v < -HALF_MAX ? -float(HALF_MAX) : v);  // keeps NaN
    });
    return std::as_bytes(std::span(halves_));
  }

  const std::vector<WrittenChannel>& channels_;
  PixelWindow data_;
  std::vector<float> floats_;
  std::vector<std::uint32_t> whole_;
  std::vector<Imath::half> halves_;
  std::vector<std::byte> samples_;
  ExrZip zip_;
};

// Takes parts of the file as soon as they are known: where they stand, and their bytes.
using Sink = std::function<void(std::size_t, std::span<const std::byte>)>;

// Puts chunks, which come from any threads, into the file in order.
class ChunkWriter {
 public:
  ChunkWriter(MemoryFile& file, int y0, int rows, int count, const Sink& sink)
      : file_(file), y_(y0), rows_(rows), waiting_(static_cast<std::size_t>(count)), sink_(sink) {}

  void put(int index, std::vector<std::byte> chunk) {
    const std::lock_guard lock(mutex_);
    waiting_[static_cast<std::size_t>(index)] = std::move(chunk);
    const std::size_t before = file_.bytes().size();
    for (; next_ < waiting_.size() && !waiting_[next_].empty(); ++next_, y_ += rows_) {
      const std::vector<std::byte> bytes = std::move(waiting_[next_]);
      require(exr_write_scanline_chunk(file_.context(), part, y_, bytes.data(), bytes.size()));
    }
    if (file_.bytes().size() > before) sink_(before, file_.bytes().subspan(before));
  }

 private:
  MemoryFile& file_;
  int y_, rows_;
  std::vector<std::vector<std::byte>> waiting_;
  std::size_t next_ = 0;
  const Sink& sink_;
  std::mutex mutex_;
};

void write_pixels(MemoryFile& file, const std::vector<WrittenChannel>& channels, const PixelWindow& data,
                  const Sink& sink) {
  std::int32_t rows = 0, count = 0;
  require(exr_get_scanlines_per_chunk(file.context(), part, &rows));
  require(exr_get_chunk_count(file.context(), part, &count));
  ChunkWriter writer(file, data.y0, rows, count, sink);
  tbb::enumerable_thread_specific<ChunkEncoder> encoders(channels, data);
  std::atomic<int> taken = 0;  // in order, so that no thread is far ahead
  tbb::parallel_for(0, count, [&](int) {
    const int i = taken++;
    writer.put(i, encoders.local().encode(data.y0 + i * rows, rows));
  });
}

// The most that a file can take, of which only what it does take becomes memory.
std::size_t most_bytes(const std::vector<WrittenChannel>& channels, const PixelWindow& data) {
  std::size_t of_pixel = 0;
  for (const WrittenChannel& c : channels) of_pixel += c.bytes();
  const auto width = static_cast<std::size_t>(data.width()), height = static_cast<std::size_t>(data.height());
  return (width * of_pixel + 16) * height;  // 16: the row of a chunk, its size, and where it is
}

Result<std::vector<std::byte>> encode(const PictureRows& picture, ExrColor color, const Sink& sink) {
  if (Status fine = check(picture); !fine) return fine.why();
  const auto channels = written_channels(picture, color);
  if (!channels) return channels.why();
  const auto entries = header_entries(picture);
  if (!entries) return entries.why();
  try {
    MemoryFile file;
    write_header(file.context(), picture, *channels, *entries);
    file.reserve(most_bytes(*channels, picture.data));
    write_pixels(file, *channels, picture.data, sink);
    return file.finish();
  } catch (const std::exception& e) { return failure(std::string("cannot encode as EXR: ") + e.what()); }
}

Diagnostics of_file(const std::filesystem::path& path, Diagnostics why) {
  for (Diagnostic& d : why) d.where.file = path.string();
  return why;
}

}  // namespace

Result<std::vector<std::byte>> encode_exr(const PictureRows& picture, ExrColor color) {
  return encode(picture, color, [](std::size_t, std::span<const std::byte>) {});
}

Result<std::vector<std::byte>> encode_exr(const Picture& picture, ExrColor color) {
  const auto rows = rows_of(picture);
  if (!rows) return rows.why();
  return encode_exr(*rows, color);
}

Status write_exr(const std::filesystem::path& path, const PictureRows& picture, ExrColor color) {
  auto file = AtomicFile::open(path);
  if (!file) return file.why();
  std::size_t head = 0;  // where the first part ends; before it stands what is known only at the end
  const auto bytes = encode(picture, color, [&](std::size_t at, std::span<const std::byte> part) {
    if (head == 0) head = at + part.size();
    file->put(at, part);
  });
  if (!bytes) return of_file(path, bytes.why());
  file->put(0, std::span(*bytes).first(head));
  return file->finish(*bytes);
}

Status write_exr(const std::filesystem::path& path, const Picture& picture, ExrColor color) {
  const auto rows = rows_of(picture);
  if (!rows) return of_file(path, rows.why());
  return write_exr(path, *rows, color);
}

}  // namespace marrow
