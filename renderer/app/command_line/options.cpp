// CLI11 speaks here and nowhere else.
#include "renderer/app/command_line/options.h"

#include <cstdio>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "renderer/app/command_line/option_values.h"
#include "renderer/app/text/print.h"
#include "renderer/output/colormap.h"
#include "renderer/scene/suggestion.h"

namespace marrow {
namespace {

std::string in_one_line(const Diagnostic& d) { return d.hint.empty() ? d.message : d.message + "; " + d.hint; }

/// An option whose text a function of ours reads; its message tells what is wrong.
template <class Target, class T>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, Target& target,
                        const std::function<Result<T>(const std::string&)>& parse, const std::string& help) {
  return app.add_option_function<std::string>(
      name,
      [&target, name, parse](const std::string& text) {
        auto value = parse(text);
        if (!value) throw CLI::ValidationError(name, in_one_line(value.why().front()));
        target = *value;
      },
      help);
}

/// A number in a range; where it is none the message says what would be right.
template <class T>
CLI::Validator from_to(T least, T most) {
  constexpr bool is_whole = std::is_integral_v<T>;
  const std::string range =
      is_whole ? fmt::format("{} to {}", least, most) : fmt::format("{:g} to {:g}", double(least), double(most));
  const auto check = [least, most, range](const std::string& text) {
    T value{};
    if (CLI::detail::lexical_cast(text, value) && value >= least && value <= most) return std::string();
    return fmt::format("a {} from {}; found '{}'", is_whole ? "whole number" : "number", range, text);
  };
  return CLI::Validator(check, range);
}

/// CLI11 would read a path as a quoted word; here it is taken as it stands.
template <class Target>
CLI::Option* add_path(CLI::App& app, const std::string& name, Target& target, const std::string& help) {
  const auto take = [](const std::string& text) -> Result<std::filesystem::path> {
    if (text.empty()) return failure("an empty name of a file");
    return std::filesystem::path(text);
  };
  return add_parsed<Target, std::filesystem::path>(app, name, target, take, help)->type_name("FILE");
}

void add_scene(CLI::App& app, SceneInput& scene) {
  add_path(app, "scene", scene.path, "Scene file (YAML)")->required()->type_name("SCENE");
  app.add_option("-D", scene.overrides, "Sets a value of the scene, such as -D camera.fov=20; may be repeated")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
}

void add_threads(CLI::App& app, int& threads) {
  app.add_option("-t,--threads", threads, "Threads; default: all that the process may use")
      ->check(from_to(1, 4096))
      ->type_name("N");
}

void add_isa(CLI::App& app, std::string& isa) {
  app.add_option("--isa", isa,
                 "Instruction set for tracing; what comes out is the same for all. Default: the widest of this machine")
      ->check(CLI::IsMember({"sse4", "avx2", "avx512"}));
}

void describe(CLI::App& app, RenderCommand& c) {
  add_scene(app, c.scene);
  add_path(app, "-o,--output", c.output, "Picture to write, .exr or .png; default: SCENE's stem, both");
  add_path(app, "--png", c.png, "PNG to write, through the view");
  app.add_option("--spp", c.samples_per_pixel, "Samples per pixel")->check(from_to(1, 1 << 24))->type_name("N");
  add_parsed<std::optional<double>, double>(app, "--time", c.time_limit_s, parse_time_limit, "Stop after this time")
      ->type_name("90s|10m|1h30m");
  add_parsed<std::optional<std::uint64_t>, std::uint64_t>(app, "--seed", c.seed, parse_seed, "Seed of the samples")
      ->type_name("N");
  add_threads(app, c.threads);
  add_parsed<std::optional<Crop>, Crop>(app, "--crop", c.crop, parse_crop, "Part of the film, in pixels or percent")
      ->type_name("x0,y0,x1,y1");
  app.add_option("--view", c.view, "View of the display for the PNG")->type_name("NAME");
  add_path(app, "--ocio", c.ocio, "OpenColorIO configuration; default: $OCIO, else the built-in one");
  add_isa(app, c.isa);
  // For tests: none of these changes the picture.
  app.add_option("--embree-isa", c.embree_isa)->check(CLI::IsMember({"sse4", "avx2", "avx512"}))->group("");
  app.add_option("--tile", c.tile_size)->check(from_to(1, 4096))->group("");
  app.add_flag("--eager", c.eager)->group("");
  auto* progress = add_parsed<ProgressStyle, ProgressStyle>(app, "--progress", c.progress, parse_progress_style,
                                                            "auto, bar, plain or json (lines on standard error)");
  progress->type_name("STYLE");
  app.add_flag_callback(
         "-q,--quiet", [&c] { c.progress = ProgressStyle::None; }, "No progress, only problems")
      ->excludes(progress);
  app.add_flag("--strict", c.strict, "Exit 1 when the picture may be wrong (samples left out, pixels not certified)");
  app.footer(
      "Examples:\n"
      "  marrow render neuron.yaml                       neuron.exr and neuron.png\n"
      "  marrow render neuron.yaml -o try.png --spp 4    a quick look\n"
      "  marrow render neuron.yaml -o a.exr --time 10m   as good as ten minutes allow\n"
      "  marrow render neuron.yaml --crop 25%,25%,75%,75% -D camera.fov=20\n"
      "SIGINT or SIGTERM: what is finished is written and the exit code is 75.");
}

void describe(CLI::App& app, CheckCommand& c) {
  add_scene(app, c.scene);
  const auto use_json = [&c](const std::string& format) { c.json = format == "json"; };
  app.add_option_function<std::string>("--format", use_json, "text, or json for editors")
      ->check(CLI::IsMember({"text", "json"}));
  app.footer("Example:\n  marrow check neuron.yaml    every mistake at once; exit 65 if there is one");
}

void describe(CLI::App& app, SchemaCommand& c) {
  app.add_flag("--markdown", c.markdown, "As text for readers instead");
  app.footer(
      "Example:\n  marrow schema > marrow.schema.json\nA scene whose first line is\n"
      "  # yaml-language-server: $schema=./marrow.schema.json\nis then checked and completed by editors.");
}

void describe(CLI::App& app, ProbeCommand& c) {
  add_scene(app, c.scene);
  app.add_option("--object", c.object, "Object to evaluate; may be left out if only one is a field")->type_name("NAME");
  add_path(app, "--points", c.points, "Points, one 'x y z' a line; - is standard input")->required();
  app.add_flag("--curvature", c.curvature,
               "Hessian and curvature of the surface too; of a single blend the Hessian of its sum");
  app.add_flag("--materials", c.materials, "What share of the field comes from each material");
  app.add_option_function<std::string>(
         "--format", [](const std::string&) {}, "json, the only one so far")
      ->check(CLI::IsMember({"json"}));
  add_threads(app, c.threads);
  app.footer(
      "Example:\n  echo 0 0 1.5 | marrow probe two_points.yaml --object pair --points - --format json\n"
      "Each point sums all skeletons as they are, to the last digits; a slice sums what is far away at once.\n"
      "SIGINT or SIGTERM: the array ends early and the exit code is 75.");
}

void describe(CLI::App& app, TraceCommand& c) {
  add_scene(app, c.scene);
  add_path(app, "--rays", c.rays, "Rays, one 'ox oy oz dx dy dz [t_min t_max]' a line; - is standard input")
      ->required();
  app.add_flag("--occluded", c.occluded, "Only whether anything is in the way, which is sooner known");
  add_threads(app, c.threads);
  add_isa(app, c.isa);
  app.add_flag("--strict", c.strict, "Exit 1 when a ray is not proved to have missed nothing");
  app.footer(
      "Example:\n  echo 0 0 9 0 0 -1 | marrow trace neuron.yaml --rays -\n"
      "The answer is a JSON array in the order of the rays; surface is at origin + t direction.\n"
      "A ray that begins inside a body meets the surface where it leaves.\n"
      "SIGINT or SIGTERM: the array ends early and the exit code is 75.");
}

void describe(CLI::App& app, InfoCommand& c) {
  add_scene(app, c.scene);
  app.add_flag("--json", c.json, "As JSON");
  add_threads(app, c.threads);
  app.footer("Example:\n  marrow info neuron.yaml    primitives, tiles, memory, bounds, lights, materials");
}

void describe(CLI::App& app, SliceCommand& c) {
  add_scene(app, c.scene);
  const std::function<Result<std::pair<int, double>>(const std::string&)> plane = parse_plane;
  app.add_option_function<std::string>(
         "--plane",
         [&c, plane](const std::string& text) {
           const auto parsed = plane(text);
           if (!parsed) throw CLI::ValidationError("--plane", in_one_line(parsed.why().front()));
           c.request.axis = parsed->first;
           c.request.offset = parsed->second;
         },
         "Plane, such as z=0")
      ->required()
      ->type_name("AXIS=OFFSET");
  app.add_option("--object", c.object, "Object to paint; default: the largest value of all fields")->type_name("NAME");
  add_path(app, "-o,--output", c.output, ".png (false colour) or .exr (raw numbers); default: slice.png");
  using Range = std::pair<double, double>;
  add_parsed<std::optional<Range>, Range>(app, "--range", c.request.range, parse_range, "Range of the colours")
      ->type_name("LOW:HIGH");
  add_parsed<std::optional<SliceWindow>, SliceWindow>(app, "--window", c.request.window, parse_window,
                                                      "Part of the plane, in scene units")
      ->type_name("u0,v0,u1,v1");
  app.add_option("--width", c.request.width, "Pixels of the field")->check(from_to(1, 1 << 15))->type_name("N");
  app.add_option("--colormap", c.request.colormap, "Colours")->check(CLI::IsMember(Colormap::names()));
  add_threads(app, c.request.threads);
  app.footer(
      "Examples:\n  marrow slice neuron.yaml --plane z=0\n"
      "  marrow slice neuron.yaml --plane y=-1.5 -o field.exr --window -2,-2,2,2 --width 2048\n"
      "SIGINT or SIGTERM: nothing is written and the exit code is 75.");
}

void describe(CLI::App& app, BenchCommand& c) {
  app.add_option(
         "workloads", c.workloads,
         "w1 (867 segments), w2 (10,000 segments), w3 (200 points), or skeletons of your own: .txt as the peers "
         "read it (docs/command-line.md), .swc, .obj, .csv, .xyz, .pdb, .hair; default: w1, w2 and w3")
      ->type_name("NAME|FILE");
  app.add_flag("--json", c.json, "As JSON");
  app.add_option("--size", c.settings.size, "Pixels of a side; default 1024")->check(from_to(16, 8192))->type_name("N");
  app.add_option("-t,--threads", c.settings.threads, "Threads of every engine; default 2")
      ->check(from_to(1, 4096))
      ->type_name("N");
  app.add_option("--rounds", c.settings.rounds, "Turns of which medians are taken; default 3")
      ->check(from_to(1, 1000))
      ->type_name("N");
  app.add_option("--mesh", c.settings.mesh_spacing,
                 "Grid of the meshed rival, scene units; 0: none; default: a 500th of the workload")
      ->check(from_to(0.0, 1e15))
      ->type_name("H");
  app.add_flag_callback(
      "--no-processes", [&c] { c.settings.processes = false; }, "Leaves out whole processes, and so POV-Ray");
  app.add_flag("--long", c.settings.many_samples, "Whole processes with --spp samples too: minutes");
  app.add_option("--spp", c.settings.samples,
                 "Samples of the long processes; default 16. POV-Ray takes the nearest square and one: 17")
      ->check(from_to(2, 4096))
      ->type_name("N");
  app.add_option("--scaling", c.settings.largest_scaling, "Also 1000, 10,000, ... segments, up to N")
      ->check(from_to(1000, 1000000))
      ->type_name("N");
  add_path(app, "--write", c.write_to, "Only writes the workloads into this folder, as scenes")->type_name("FOLDER");
  app.footer(
      "Examples:\n  marrow bench                        all workloads, and the peers that are installed\n"
      "  marrow bench neuron.swc --mesh 0    a skeleton of your own, blended, against Embree's round cones\n"
      "  marrow bench w1 --long              with 16 samples a pixel against POV-Ray\n"
      "  marrow bench --scaling 1000000      what grows with the number of segments\n"
      "  marrow bench w2 --write scenes      w2.yaml, to render or to profile\n"
      "Engines run in turns; ratios are medians over the turns. `cpu` is user and system time of all threads.");
}

ExitCode usage_error(const std::string& message, const std::string& hint, const std::string& help) {
  complain(fmt::format("marrow: {}{}\n  {} --help explains\n", message, hint.empty() ? "" : "; " + hint, help));
  return ExitCode::Usage;
}

std::vector<std::string> names_of(const std::vector<CLI::App*>& commands) {
  std::vector<std::string> names;
  for (const auto* command : commands) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> options_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const auto* option : app.get_options())
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

// Options that take one value and have several.
std::string given_too_often(const CLI::App& app) {
  for (const auto* option : app.get_options())
    if (option->get_expected_max() == 1 && option->count() > 1)
      return fmt::format("{} is given {} times; once is enough", option->get_name(), option->count());
  return "";
}

// The first word that no option and no argument takes; empty when all are taken. `--` ends the options.
std::string unexpected_word(const CLI::App& app) {
  for (const std::string& word : app.remaining())
    if (word != "--") return word;
  return "";
}

// CLI11 has its own exit codes and wording; what a caller sees is ours.
ExitCode explain(const CLI::App& app, const CLI::ParseError& error) {
  const auto chosen = app.get_subcommands();
  const CLI::App& speaker = chosen.empty() ? app : *chosen.front();
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
    say(error.get_name() == "CallForVersion" ? std::string(error.what()) + "\n" : app.help());
    return ExitCode::Ok;
  }
  const std::string help = chosen.empty() ? "marrow" : "marrow " + speaker.get_name();
  const auto is = [&](CLI::ExitCodes code) { return error.get_exit_code() == static_cast<int>(code); };
  const std::string repeated = given_too_often(speaker), unexpected = unexpected_word(speaker);
  if (is(CLI::ExitCodes::ArgumentMismatch) && !repeated.empty()) return usage_error(repeated, "", help);
  // What is missing may be what was misspelt.
  const bool is_extra = is(CLI::ExitCodes::ExtrasError) || is(CLI::ExitCodes::RequiredError);
  if (!is_extra || unexpected.empty()) return usage_error(error.what(), "", help);
  const auto guess = nearest(unexpected, options_of(speaker));
  return usage_error("'" + unexpected + "' was not expected", guess ? "did you mean " + *guess + "?" : "", help);
}

}  // namespace

std::variant<Command, ExitCode> parse_options(int argc, const char* const* argv) {
  CLI::App app{"Marrow traces rays to implicit surfaces grown on skeletons.", "marrow"};
  app.set_version_flag("--version", "marrow " MARROW_VERSION);
  app.require_subcommand(1);
  app.footer(
      "marrow COMMAND --help explains a command. Exit codes: 0 done, 1 done but in doubt (--strict),\n"
      "2 command line, 65 bad scene, 66 no input, 69 not available, 70 internal error,\n"
      "73 and 74 cannot write, 75 interrupted.");

  RenderCommand render;
  CheckCommand check;
  SchemaCommand schema;
  ProbeCommand probe;
  TraceCommand trace;
  InfoCommand info;
  SliceCommand slice;
  BenchCommand bench;
  const auto add = [&app](const char* name, const char* help, auto& command) {
    auto* sub = app.add_subcommand(name, help);
    describe(*sub, command);
    return sub;
  };
  const std::vector<std::pair<CLI::App*, std::function<Command()>>> commands{
      {add("render", "Makes a picture of a scene", render), [&] { return render; }},
      {add("check", "Tells every mistake of a scene", check), [&] { return check; }},
      {add("info", "Tells what a scene is made of", info), [&] { return info; }},
      {add("slice", "Paints a field on an axis plane", slice), [&] { return slice; }},
      {add("probe", "Evaluates a field at points", probe), [&] { return probe; }},
      {add("trace", "Traces rays and tells what they meet", trace), [&] { return trace; }},
      {add("schema", "Prints the scene format as JSON Schema", schema), [&] { return schema; }},
      {add("bench", "Measures itself and its peers on common scenes", bench), [&] { return bench; }},
  };

  const bool asks_for_help = argc > 1 && argv[1] == std::string_view("help");
  const int place = asks_for_help ? 2 : 1;  // of the command
  const char* const word = argc > place ? argv[place] : "";
  const auto names = names_of(app.get_subcommands({}));
  const bool is_known = std::find(names.begin(), names.end(), word) != names.end();
  if (*word != '\0' && *word != '-' && !is_known)
    return usage_error(fmt::format("there is no command '{}'", word), suggest(word, names), "marrow");
  if (asks_for_help) {
    say(is_known ? app.get_subcommand(word)->help("marrow") : app.help());
    return ExitCode::Ok;
  }
  if (argc < 2) {
    complain(app.help());
    return ExitCode::Usage;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) { return explain(app, error); }
  for (const auto& [sub, command] : commands)
    if (sub->parsed()) return command();
  return ExitCode::Internal;
}

}  // namespace marrow
