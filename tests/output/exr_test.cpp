// Laws of EXR files: nothing is lost, nothing broken is taken, the same picture gives the same bytes.
#include "renderer/output/exr.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include "tests/output/temporary_folder.h"

namespace marrow {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Pair;

class SourceDateEpoch {
 public:
  explicit SourceDateEpoch(const char* seconds) { setenv("SOURCE_DATE_EPOCH", seconds, 1); }
  ~SourceDateEpoch() { unsetenv("SOURCE_DATE_EPOCH"); }
  SourceDateEpoch(const SourceDateEpoch&) = delete;
  SourceDateEpoch& operator=(const SourceDateEpoch&) = delete;
};

// Channels in EXR's order, so that a picture read back can be compared as it is.
Picture make_picture(const PixelWindow& display, const PixelWindow& data) {
  constexpr unsigned seed = 7;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, 100);
  const std::size_t pixels = static_cast<std::size_t>(data.width()) * static_cast<std::size_t>(data.height());
  Picture p{.display = display, .data = data, .channels = {}, .metadata = {}};
  for (const char* name : {"A", "B", "G", "N.X", "R", "Z"}) {
    std::vector<float> samples(pixels);
    for (float& v : samples) v = normal(random);
    p.channels.push_back({name, std::move(samples)});
  }
  std::vector<std::uint32_t> counts(pixels);
  for (auto& v : counts) v = static_cast<std::uint32_t>(random());
  counts.back() = std::numeric_limits<std::uint32_t>::max();
  p.channels.push_back({"samples", std::move(counts)});
  p.metadata = {{"comments", std::string("µm")}, {"marrow/seed", 42}, {"marrow/renderTime", 0.1}};
  return p;
}

const std::vector<float>& floats(const Picture& p, const std::string& name) {
  for (const Channel& c : p.channels)
    if (c.name == name) return std::get<std::vector<float>>(c.samples);
  throw std::out_of_range(name);
}

void expect_same_pixels(const Picture& got, const Picture& want) {
  EXPECT_EQ(got.display, want.display);
  EXPECT_EQ(got.data, want.data);
  ASSERT_EQ(got.channels.size(), want.channels.size());
  for (std::size_t i = 0; i < want.channels.size(); ++i) {
    EXPECT_EQ(got.channels[i].name, want.channels[i].name);
    EXPECT_TRUE(got.channels[i].samples == want.channels[i].samples) << want.channels[i].name;
  }
}

TEST(Exr, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  for (const PixelWindow& data : {PixelWindow{0, 0, 60, 35}, PixelWindow{7, 11, 24, 30}, PixelWindow{-5, -3, 1, 9}}) {
    const Picture want = make_picture({0, 0, 60, 35}, data);
    ASSERT_TRUE(write_exr(folder / "a.exr", want));
    const auto got = read_exr(folder / "a.exr");
    ASSERT_TRUE(got) << got.why().front().message;
    expect_same_pixels(*got, want);
    for (const auto& entry : want.metadata) EXPECT_THAT(got->metadata, Contains(entry));
  }
}

TEST(Exr, WhatWasReadCanBeWrittenAgainToTheSameBytes) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_exr(folder / "a.exr", make_picture({0, 0, 60, 35}, {7, 11, 24, 30})));
  const auto picture = read_exr(folder / "a.exr");
  ASSERT_TRUE(picture);
  ASSERT_TRUE(write_exr(folder / "b.exr", *picture));
  EXPECT_EQ(read_text(folder / "a.exr"), read_text(folder / "b.exr"));
}

TEST(Exr, KeepsInfinitiesAndNotANumber) {
  const TemporaryFolder folder;
  const float inf = std::numeric_limits<float>::infinity();
  const Picture p{{0, 0, 3, 1}, {0, 0, 3, 1}, {{"Z", std::vector<float>{inf, -inf, std::nanf("")}}}, {}};
  ASSERT_TRUE(write_exr(folder / "a.exr", p));
  const auto got = read_exr(folder / "a.exr");
  ASSERT_TRUE(got);
  const auto& z = floats(*got, "Z");
  EXPECT_EQ(z[0], inf);
  EXPECT_EQ(z[1], -inf);
  EXPECT_TRUE(std::isnan(z[2]));
}

TEST(Exr, HalfColorsLoseOnlyColors) {
  const TemporaryFolder folder;
  Picture p = make_picture({0, 0, 9, 9}, {0, 0, 9, 9});
  std::get<std::vector<float>>(p.channels[4].samples)[0] = 1e9f;
  ASSERT_TRUE(write_exr(folder / "a.exr", p, ExrColor::Half));
  const auto got = read_exr(folder / "a.exr");
  ASSERT_TRUE(got);
  EXPECT_EQ(floats(*got, "Z"), floats(p, "Z"));
  EXPECT_EQ(floats(*got, "N.X"), floats(p, "N.X"));
  EXPECT_EQ(floats(*got, "R")[0], 65504.f);
  for (std::size_t i = 0; i < 81; ++i)  // 11 bits, rounded to nearest
    EXPECT_NEAR(floats(*got, "G")[i], floats(p, "G")[i], std::ldexp(std::fabs(floats(p, "G")[i]), -11));
}

TEST(Exr, SameBytesForAnyNumberOfThreads) {
  const SourceDateEpoch epoch("1700000000");
  const Picture p = make_picture({0, 0, 200, 150}, {0, 0, 200, 150});
  std::vector<std::vector<std::byte>> files;
  for (const std::size_t threads : {1, 2, 7}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    files.push_back(*encode_exr(p));
  }
  EXPECT_TRUE(files[0] == files[1]);
  EXPECT_TRUE(files[0] == files[2]);
}

TEST(Exr, HeaderSaysWhatTheNumbersMean) {
  const TemporaryFolder folder;
  const SourceDateEpoch epoch("1700000000");
  Picture p = make_picture({0, 0, 4, 4}, {0, 0, 4, 4});
  ASSERT_TRUE(write_exr(folder / "a.exr", p));
  const auto color = read_exr(folder / "a.exr");
  EXPECT_THAT(color->metadata, Contains(Pair("capDate", Metadata("2023:11:14 22:13:20"))));
  EXPECT_THAT(color->metadata, Contains(Pair("colorInteropID", Metadata("lin_rec709_scene"))));
  EXPECT_THAT(color->metadata, Contains(Pair("Software", ::testing::VariantWith<std::string>(HasSubstr("marrow ")))));

  std::erase_if(p.channels, [](const Channel& c) { return c.name != "Z"; });
  ASSERT_TRUE(write_exr(folder / "a.exr", p));
  EXPECT_THAT(read_exr(folder / "a.exr")->metadata, Contains(Pair("colorInteropID", Metadata("data"))));
}

TEST(Exr, RefusesABadDate) {
  const SourceDateEpoch epoch("yesterday");
  const auto bytes = encode_exr(make_picture({0, 0, 4, 4}, {0, 0, 4, 4}));
  ASSERT_FALSE(bytes);
  EXPECT_THAT(bytes.why().front().message, HasSubstr("yesterday"));
}

TEST(Exr, RefusesPicturesThatContradictThemselves) {
  Picture p = make_picture({0, 0, 4, 4}, {0, 0, 4, 4});
  p.channels.push_back(p.channels.front());
  EXPECT_FALSE(encode_exr(p)) << "a channel twice";
  p.channels.back() = {"more", std::vector<float>(15)};
  EXPECT_FALSE(encode_exr(p)) << "too few samples";
  p.channels.clear();
  EXPECT_FALSE(encode_exr(p)) << "no channels";
  EXPECT_FALSE(encode_exr(Picture{})) << "no pixels";
}

TEST(Exr, RefusesEveryFileCutShort) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_exr(folder / "a.exr", make_picture({0, 0, 60, 35}, {0, 0, 60, 35})));
  const std::string whole = read_text(folder / "a.exr");
  ASSERT_GT(whole.size(), 1000u);
  for (std::size_t length = 0; length < whole.size(); length += length + 200 < whole.size() ? 101 : 1) {
    write_text(folder / "cut.exr", whole.substr(0, length));
    EXPECT_FALSE(read_exr(folder / "cut.exr")) << length << " of " << whole.size();
  }
}

TEST(Exr, ErrorsNameTheFile) {
  const auto missing = read_exr("no/such.exr");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.why().front().where.file, "no/such.exr");
}

}  // namespace
}  // namespace marrow
