// Laws of the golden runner, with a stand-in for the program that copies a prepared picture.
#include "tests/golden/golden_run.h"

#include <gmock/gmock.h>

#include "renderer/output/exr.h"
#include "tests/output/temporary_folder.h"

namespace marrow {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

Picture flat(float value) {
  Picture p{{0, 0, 8, 8}, {0, 0, 8, 8}, {}, {}};
  for (const char* name : {"R", "Z"}) p.channels.push_back({name, std::vector<float>(64, value)});
  return p;
}

class GoldenRun : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "golden/ball");
    write_text(folder_ / "program", "#!/bin/sh\necho \"$@\" > \"" + (folder_ / "called").string() + "\"\ncp \"" +
                                        (folder_ / "next.exr").string() + "\" \"$4\"\n");
    fs::permissions(folder_ / "program", fs::perms::owner_all);
    write_text(folder_ / "golden/ball/expect.json",
               R"({"scene": "ball.yaml", "overrides": {"film.width": 8}, "arguments": ["--spp", "1"],
                   "channels": ["Z"], "thresholds": {"fail": 0.1}, "why": "a test"})");
  }
  Expectation expectation() { return *read_expectation(folder_ / "golden/ball"); }
  GoldenSetup setup() {
    return {.program = folder_ / "program", .repository = folder_.path(), .work = folder_ / "work"};
  }
  void program_renders(float value) { ASSERT_TRUE(write_exr(folder_ / "next.exr", flat(value))); }

  TemporaryFolder folder_;
};

TEST_F(GoldenRun, UpdateThenCheckPasses) {
  program_renders(1);
  ASSERT_TRUE(update_golden(expectation(), setup()));
  const auto text = check_golden(expectation(), setup());
  ASSERT_TRUE(text) << text.why().front().message;
  EXPECT_THAT(*text, HasSubstr("a test"));
  EXPECT_FALSE(fs::exists(folder_ / "work/ball/difference.exr"));
  EXPECT_EQ(read_exr(expectation().reference)->channels.size(), 1u) << "only what is compared is kept";
}

TEST_F(GoldenRun, ProgramGetsSceneOutputOverridesAndArguments) {
  program_renders(1);
  ASSERT_TRUE(update_golden(expectation(), setup()));
  EXPECT_EQ(read_text(folder_ / "called"), "render " + (folder_ / "ball.yaml").string() + " -o " +
                                               (folder_ / "work/ball/got.exr").string() +
                                               " --quiet -D film.width=8 --spp 1\n");
}

TEST_F(GoldenRun, FailureLeavesEvidence) {
  program_renders(1);
  ASSERT_TRUE(update_golden(expectation(), setup()));
  program_renders(1.5f);
  const auto text = check_golden(expectation(), setup());
  ASSERT_FALSE(text);
  EXPECT_THAT(text.why().front().message, HasSubstr("FAIL  Z"));
  for (const char* file : {"got.exr", "want.exr", "difference.exr"})
    EXPECT_TRUE(read_exr(folder_ / "work/ball" / file));
  EXPECT_THAT(read_text(folder_ / "work/ball/report.txt"), HasSubstr("0.5"));
  EXPECT_EQ(std::get<std::vector<float>>(read_exr(folder_ / "work/ball/difference.exr")->channels[0].samples)[0], 0.5f);
}

TEST_F(GoldenRun, AProgramThatFailsOrWritesNothingIsAFailure) {
  program_renders(1);
  ASSERT_TRUE(update_golden(expectation(), setup()));
  write_text(folder_ / "program", "#!/bin/sh\nexit 65\n");
  EXPECT_FALSE(check_golden(expectation(), setup()));
  write_text(folder_ / "program", "#!/bin/sh\nexit 0\n");
  EXPECT_FALSE(check_golden(expectation(), setup())) << "an old got.exr must not count";
  fs::remove(folder_ / "program");
  EXPECT_FALSE(check_golden(expectation(), setup()));
}

TEST_F(GoldenRun, ExpectationsAreStrict) {
  const auto refuses = [&](const std::string& text) {
    write_text(folder_ / "golden/ball/expect.json", text);
    return !read_expectation(folder_ / "golden/ball");
  };
  EXPECT_TRUE(refuses(R"({"scene": "a", "channels": ["Z"]})")) << "no why";
  EXPECT_TRUE(refuses(R"({"scene": "a", "channels": [], "why": "x"})"));
  EXPECT_TRUE(refuses(R"({"scene": "a", "channels": ["Z"], "why": "x", "treshold": {}})"));
  EXPECT_TRUE(refuses(R"({"scene": "a", "channels": ["Z"], "why": "x", "thresholds": {"fial": 1}})"));
  EXPECT_TRUE(refuses("{"));
  EXPECT_FALSE(refuses(R"({"scene": "a", "channels": ["Z"], "why": "x"})"));
}

}  // namespace
}  // namespace marrow
