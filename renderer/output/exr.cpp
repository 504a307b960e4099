#include "renderer/output/exr.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include "field/base/overloaded.h"
#include "renderer/output/atomic_file.h"

namespace marrow {
namespace {

using Imath::Box2i;

constexpr std::int64_t most_pixels = std::int64_t{1} << 28;
constexpr std::int64_t most_samples = std::int64_t{1} << 31;

// OpenEXR writes into memory: nothing can fail there but the memory itself, and the disk is the business of
// write_file_atomically.
class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("memory") {}
  void write(const char* data, int count) override {
    const std::size_t n = static_cast<std::size_t>(count);
    if (bytes_.size() < at_ + n) bytes_.resize(at_ + n);
    std::memcpy(bytes_.data() + at_, data, n);
    at_ += n;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = at; }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
  std::size_t at_ = 0;
};

// OpenEXR's global pool can hang at exit if it still has threads, so it has some only while a file is compressed.
class CompressionThreads {
 public:
  CompressionThreads() : lock_(mutex()) {
    const std::size_t allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    Imf::setGlobalThreadCount(allowed > 1 ? static_cast<int>(std::min<std::size_t>(allowed, 64)) : 0);
  }
  ~CompressionThreads() { Imf::setGlobalThreadCount(0); }
  CompressionThreads(const CompressionThreads&) = delete;
  CompressionThreads& operator=(const CompressionThreads&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex m;
    return m;
  }
  std::lock_guard<std::mutex> lock_;
};

// EXR's windows include their last pixel.
Box2i box_of(const PixelWindow& w) { return {{w.x0, w.y0}, {w.x1 - 1, w.y1 - 1}}; }
PixelWindow window_of(const Box2i& b) { return {b.min.x, b.min.y, b.max.x + 1, b.max.y + 1}; }

bool is_color(std::string_view name) {
  return name == "R" || name == "G" || name == "B" || name == "A" || name.starts_with("albedo.");
}

std::size_t sample_count(const Channel& c) {
  return std::visit([](const auto& samples) { return samples.size(); }, c.samples);
}

Status check(const Picture& picture) {
  if (picture.display.width() <= 0 || picture.display.height() <= 0 || picture.data.width() <= 0 ||
      picture.data.height() <= 0)
    return failure("the picture has no pixels");
  if (picture.channels.empty()) return failure("the picture has no channels");
  const std::size_t pixels =
      static_cast<std::size_t>(picture.data.width()) * static_cast<std::size_t>(picture.data.height());
  std::set<std::string_view> names;
  for (const Channel& c : picture.channels) {
    if (!names.insert(c.name).second) return failure("channel " + c.name + " occurs twice");
    if (sample_count(c) != pixels)
      return failure(fmt::format("channel {} has {} samples for {} pixels", c.name, sample_count(c), pixels));
  }
  return Done{};
}

// ---- header ----

// As the EXR standard writes dates.   [https://reproducible-builds.org/specs/source-date-epoch/]
Result<std::string> capture_date() {
  std::time_t when = std::time(nullptr);
  if (const char* epoch = std::getenv("SOURCE_DATE_EPOCH")) {
    const std::string_view text(epoch);
    long long seconds = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
    if (error != std::errc{} || end != text.data() + text.size())
      return failure("SOURCE_DATE_EPOCH is \"" + std::string(text) + "\", not a whole number of seconds");
    when = static_cast<std::time_t>(seconds);
  }
  std::tm t{};
  if (!gmtime_r(&when, &t)) return failure("SOURCE_DATE_EPOCH is beyond the calendar");
  return fmt::format("{:04}:{:02}:{:02} {:02}:{:02}:{:02}", t.tm_year + 1900, t.tm_mon + 1, t.tm_mday, t.tm_hour,
                     t.tm_min, t.tm_sec);
}

void insert(Imf::Header& header, const std::string& name, const Metadata& value) {
  std::visit(Overloaded{
                 [&](const std::string& s) { header.insert(name, Imf::StringAttribute(s)); },
                 [&](int i) { header.insert(name, Imf::IntAttribute(i)); },
                 [&](double d) { header.insert(name, Imf::DoubleAttribute(d)); },
             },
             value);
}

void insert_chromaticities(Imf::Header& header) {
  using Imath::V2f;
  const auto* id = header.findTypedAttribute<Imf::StringAttribute>("colorInteropID");
  if (!id) return;
  if (id->value() == "lin_rec709_scene")  // Rec. ITU-R BT.709-6, item 1.3 and 1.4
    Imf::addChromaticities(header, {V2f(.64f, .33f), V2f(.30f, .60f), V2f(.15f, .06f), V2f(.3127f, .3290f)});
  if (id->value() == "lin_ap1_scene")  // Academy S-2014-004, ACEScg
    Imf::addChromaticities(header, {V2f(.713f, .293f), V2f(.165f, .830f), V2f(.128f, .044f), V2f(.32168f, .33767f)});
}

Result<Imf::Header> make_header(const Picture& picture, ExrColor color) {
  const Result<std::string> date = capture_date();
  if (!date) return date.why();
  Imf::Header header(box_of(picture.display), box_of(picture.data));
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = 1;  // half the time of the default level, files 3 % larger

  bool has_color = false;
  for (const Channel& c : picture.channels) {
    const bool whole = std::holds_alternative<std::vector<std::uint32_t>>(c.samples);
    const bool half = !whole && color == ExrColor::Half && is_color(c.name);
    header.channels().insert(c.name, Imf::Channel(whole ? Imf::UINT : half ? Imf::HALF : Imf::FLOAT));
    has_color = has_color || c.name == "R";
  }
  insert(header, "Software", "marrow " MARROW_VERSION);
  insert(header, "capDate", *date);
  Imf::addUtcOffset(header, 0);
  insert(header, "colorInteropID", has_color ? "lin_rec709_scene" : "data");
  for (const auto& [name, value] : picture.metadata) insert(header, name, value);
  insert_chromaticities(header);
  return header;
}

// ---- pixels ----

// Where OpenEXR finds pixel (x, y) of a channel: base + x * size + y * width * size with coordinates of the film, so
// that the base of a crop lies before its memory.
Imf::Slice slice_of(Imf::PixelType type, const void* samples, std::size_t size, const PixelWindow& data) {
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(size), width = data.width();
  const std::uintptr_t base =
      reinterpret_cast<std::uintptr_t>(samples) - static_cast<std::uintptr_t>((data.y0 * width + data.x0) * stride);
  return {type, reinterpret_cast<char*>(base), size, size * static_cast<std::size_t>(data.width())};
}

std::vector<Imath::half> to_half(const std::vector<float>& samples) {
  std::vector<Imath::half> halves(samples.size());
  std::transform(samples.begin(), samples.end(), halves.begin(), [](float v) {
    return Imath::half(v > HALF_MAX ? float(HALF_MAX) : v < -HALF_MAX ? -float(HALF_MAX) : v);  // keeps NaN
  });
  return halves;
}

std::vector<std::byte> encode(const Picture& picture, const Imf::Header& header) {
  const CompressionThreads threads;
  std::vector<std::vector<Imath::half>> halves;
  halves.reserve(picture.channels.size());  // so that their memory stays where the slices point
  Imf::FrameBuffer pixels;
  for (const Channel& c : picture.channels) {
    const Imf::PixelType type = header.channels()[c.name].type;
    if (const auto* whole = std::get_if<std::vector<std::uint32_t>>(&c.samples)) {
      pixels.insert(c.name, slice_of(type, whole->data(), sizeof(std::uint32_t), picture.data));
    } else if (const auto& samples = std::get<std::vector<float>>(c.samples); type == Imf::HALF) {
      halves.push_back(to_half(samples));
      pixels.insert(c.name, slice_of(type, halves.back().data(), sizeof(Imath::half), picture.data));
    } else {
      pixels.insert(c.name, slice_of(type, samples.data(), sizeof(float), picture.data));
    }
  }
  MemoryStream stream;
  {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(pixels);
    file.writePixels(picture.data.height());
  }  // the destructor writes the table of line offsets
  return stream.take();
}

// ---- reading ----

Status check(const Imf::Header& header) {
  if (header.hasType() && Imf::isDeepData(header.type())) return failure("deep pictures are not read");
  const PixelWindow data = window_of(header.dataWindow());
  const std::int64_t pixels = std::int64_t{data.width()} * data.height();
  std::int64_t samples = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
      return failure(fmt::format("channel {} is subsampled", c.name()));
    samples += pixels;
  }
  if (pixels > most_pixels || samples > most_samples)
    return failure(fmt::format("{} x {} pixels are too many", data.width(), data.height()));
  return Done{};
}

std::vector<std::pair<std::string, Metadata>> read_metadata(const Imf::Header& header) {
  std::vector<std::pair<std::string, Metadata>> metadata;
  for (auto a = header.begin(); a != header.end(); ++a) {
    const std::string name = a.name();
    if (name == "type") continue;  // of the part, not of the picture
    if (auto s = dynamic_cast<const Imf::StringAttribute*>(&a.attribute())) metadata.emplace_back(name, s->value());
    if (auto i = dynamic_cast<const Imf::IntAttribute*>(&a.attribute())) metadata.emplace_back(name, i->value());
    if (auto d = dynamic_cast<const Imf::DoubleAttribute*>(&a.attribute())) metadata.emplace_back(name, d->value());
  }
  return metadata;
}

Result<Picture> decode(Imf::InputFile& file) {
  const Imf::Header& header = file.header();
  if (Status fine = check(header); !fine) return fine.why();
  Picture picture{.display = window_of(header.displayWindow()),
                  .data = window_of(header.dataWindow()),
                  .channels = {},
                  .metadata = read_metadata(header)};
  const std::size_t pixels =
      static_cast<std::size_t>(picture.data.width()) * static_cast<std::size_t>(picture.data.height());
  Imf::FrameBuffer buffer;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    if (c.channel().type == Imf::UINT) {
      std::vector<std::uint32_t> samples(pixels);
      buffer.insert(c.name(), slice_of(Imf::UINT, samples.data(), sizeof(std::uint32_t), picture.data));
      picture.channels.push_back({c.name(), std::move(samples)});
    } else {
      std::vector<float> samples(pixels);
      buffer.insert(c.name(), slice_of(Imf::FLOAT, samples.data(), sizeof(float), picture.data));
      picture.channels.push_back({c.name(), std::move(samples)});
    }
  }
  file.setFrameBuffer(buffer);
  file.readPixels(picture.data.y0, picture.data.y1 - 1);  // throws when lines are missing
  return picture;
}

}  // namespace

Result<std::vector<std::byte>> encode_exr(const Picture& picture, ExrColor color) {
  if (Status fine = check(picture); !fine) return fine.why();
  try {
    const Result<Imf::Header> header = make_header(picture, color);
    if (!header) return header.why();
    return encode(picture, *header);
  } catch (const std::exception& e) { return failure(std::string("cannot encode as EXR: ") + e.what()); }
}

Status write_exr(const std::filesystem::path& path, const Picture& picture, ExrColor color) {
  const auto bytes = encode_exr(picture, color);
  if (!bytes) {
    Diagnostics why = bytes.why();
    for (Diagnostic& d : why) d.where.file = path.string();
    return why;
  }
  return write_file_atomically(path, *bytes);
}

Result<Picture> read_exr(const std::filesystem::path& path) {
  try {
    // Before any table as long as the claimed height is allocated
    Imf::Header::setMaxImageSize(1 << 20, 1 << 20);
    Imf::InputFile file(path.c_str());
    Result<Picture> picture = decode(file);
    if (picture) return picture;
    Diagnostics why = picture.why();
    for (Diagnostic& d : why) d.where.file = path.string();
    return why;
  } catch (const std::exception& e) { return failure(std::string("cannot read: ") + e.what(), path.string()); }
}

}  // namespace marrow
