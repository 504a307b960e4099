// What has no answer is said to have none, to people and to programs.
#include "renderer/app/report/bench_report.h"

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace marrow {
namespace {

// A workload with Marrow and the cones, of which all is known.
WorkloadFigures known() {
  WorkloadFigures w;
  w.name = "test";
  w.sample = {.wall_s = .25, .cpu_s = .5};
  w.sample_over_cones = {.wall = 2, .cpu = 3};
  w.rules.push_back({"contact", {.wall = 1.5, .cpu = 1.25}});
  EngineFigures own;
  own.name = "marrow";
  own.frame.rays = own.bounces.rays = 100;
  own.frame_proof = {.evaluations = 250, .uncertified = 3};
  own.bounce_proof = {.evaluations = 150, .uncertified = 0};
  own.bounce_cost = Cost{1e-6, 2e-6};
  own.frame_ratio = own.bounce_ratio = {.wall = 1, .cpu = 1};
  EngineFigures cones = own;
  cones.name = "embree round cones";
  cones.frame_proof = cones.bounce_proof = {};
  cones.frame_ratio = cones.bounce_ratio = {.wall = 1.5, .cpu = 1.75};
  w.engines = {own, cones};
  return w;
}

nlohmann::json json_of(const WorkloadFigures& w) { return nlohmann::json::parse(bench_json({}, {w}))["workloads"][0]; }

::testing::AssertionResult says(const std::string& text, const std::string& words) {
  if (text.find(words) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "no \"" << words << "\" in\n" << text;
}

TEST(BenchReport, TellsWhatIsKnown) {
  const std::string text = bench_text(known());
  EXPECT_TRUE(says(text, "0.250 s wall, 0.500 s cpu; 2.00 times round cones (cpu 3.00)"));
  EXPECT_TRUE(says(text, "1.250 times the plain sum"));
  EXPECT_TRUE(says(text, "2.50, 1.50 of bounces"));
  EXPECT_TRUE(says(text, "3 of 100"));
  EXPECT_TRUE(says(text, "1.75x"));
  EXPECT_FALSE(says(text, "too short"));
  const auto json = json_of(known());
  EXPECT_EQ(json["further_sample"]["wall_seconds"], .25);
  EXPECT_EQ(json["engines"][0]["evaluations_per_ray"], 2.5);
  EXPECT_EQ(json["engines"][0]["uncertified_rays"], 3);
}

TEST(BenchReport, TellsWhatIsTooShort) {
  WorkloadFigures w = known();
  w.sample = {};
  w.sample_over_cones = w.rules[0].over_sum = w.engines[1].frame_ratio = w.engines[1].bounce_ratio = {};
  const std::string text = bench_text(w);
  EXPECT_TRUE(says(text, "one further sample        too short to tell\n"));
  EXPECT_TRUE(says(text, "alpha: contact            too short to tell\n"));
  EXPECT_TRUE(says(text, "too short      2000 ns  too short\n"));
  const auto json = json_of(w);
  EXPECT_TRUE(json["further_sample"]["cpu_seconds"].is_null());
  EXPECT_TRUE(json["further_sample_over_round_cones"]["wall"].is_null());
  EXPECT_TRUE(json["rules"][0]["over_plain_sum"]["cpu"].is_null());
  EXPECT_TRUE(json["engines"][1]["marrow_frame_over_this"]["cpu"].is_null());
}

TEST(BenchReport, EnginesThatProveNothingSayNothing) {
  const auto cones = json_of(known())["engines"][1];
  for (const char* figure : {"evaluations_per_ray", "uncertified_rays", "bounce_evaluations_per_ray"})
    EXPECT_TRUE(cones[figure].is_null()) << figure;
}

TEST(BenchReport, OfAViewWithoutHits) {
  WorkloadFigures w = known();
  for (EngineFigures& e : w.engines) {
    e.bounces = {};
    e.bounce_cost = {};
    e.bounce_ratio = {};
  }
  EXPECT_TRUE(says(bench_text(w), "no hits          -\n"));
  EXPECT_TRUE(says(bench_text(w), "2.50, no hits to bounce from"));
  for (const auto& engine : json_of(w)["engines"])
    for (const char* figure : {"bounce_ray", "bounce_rays_per_second", "bounce_evaluations_per_ray"})
      EXPECT_TRUE(engine[figure].is_null()) << figure;
}

TEST(BenchReport, ComparesProcessesByBothTimes) {
  WorkloadFigures w = known();
  w.processes.push_back({"marrow", 17, {1, 2}, 0, {.wall = 1, .cpu = 1}});
  w.processes.push_back({"povray blob", 17, {5, 8}, 0, {.wall = 5, .cpu = 4}});
  w.processes.push_back({"povray blob", 2, {5, 8}, 0, {}});
  const std::string text = bench_text(w);
  EXPECT_TRUE(says(text, "5.0 times Marrow's (wall), 4.0 (cpu)\n"));
  EXPECT_TRUE(says(text, "not compared with Marrow's\n"));
  EXPECT_FALSE(says(text, "1.0 times Marrow's"));
  EXPECT_EQ(json_of(w)["processes"][1]["samples_per_pixel"], 17);
  EXPECT_TRUE(json_of(w)["processes"][2]["this_over_marrow"]["wall"].is_null());
}

}  // namespace
}  // namespace marrow
