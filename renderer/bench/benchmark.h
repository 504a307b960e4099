// The workloads run, with Marrow and what there is of its peers in turns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "field/base/result.h"
#include "renderer/bench/cost.h"
#include "renderer/bench/ray_engine.h"
#include "renderer/bench/stop_request.h"
#include "renderer/bench/workload.h"

namespace marrow {

struct BenchSettings {
  int size = 1024;  ///< pixels of a side
  int threads = 2;
  int rounds = 3;    ///< of which medians are taken
  int samples = 16;  ///< of the longer whole run
  /// Grid of the meshed rival, scene units; 0 leaves it out. Default: a 500th of the workload's largest side,
  /// or finest_mesh_spacing() where that is more.
  std::optional<double> mesh_spacing = {};
  bool processes = true;  ///< whole processes too: this program, and POV-Ray where it is installed
  bool povray = true;
  bool rules = true;                ///< rules for `alpha` against the plain sum
  bool many_samples = false;        ///< whole processes with `samples` samples too: minutes
  std::size_t largest_scaling = 0;  ///< strands of 10^3, 10^4, ... segments up to this many; 0: none
  StopRequest stop = {};            ///< the workload at work is given up, those after it are not begun
};

/// What only Marrow tells of its rays.
struct RayProof {
  std::uint64_t evaluations = 0;  ///< of the field, for the nearest hits
  std::uint64_t uncertified = 0;  ///< rays for which it is not proved that nothing was skipped
};

/// An engine on a workload. Cost of a frame: a ray through each pixel and a shadow ray from each hit that faces the
/// sun.
struct EngineFigures {
  std::string name;
  std::size_t primitives = 0;  ///< cones, spheres or triangles; of Marrow segments and points
  double mesh_s = 0;           ///< wall time of meshing, by the rays of Marrow from the file on
  double build_s = 0;          ///< wall time until rays can be traced, without meshing
  RayCounts frame;
  Cost frame_cost;
  std::optional<RayProof> frame_proof;
  RayCounts bounces;                ///< rays of diffuse paths from the frame's hits
  std::optional<Cost> bounce_cost;  ///< of a ray; nothing when the frame has no hits
  std::optional<RayProof> bounce_proof;
  Ratio frame_ratio, bounce_ratio;  ///< Marrow's cost of a ray over this engine's
};

/// A whole process, from its start to its end.
struct ProcessFigures {
  std::string name;
  int samples = 0;  ///< per pixel, as many as it really took
  Cost cost;
  std::size_t peak_bytes = 0;
  Ratio ratio;  ///< its cost over Marrow's with the same number of samples
};

/// A rule for `alpha` against the plain sum.
struct RuleFigures {
  std::string alpha;
  Ratio over_sum;  ///< of further samples
};

struct WorkloadFigures {
  std::string name, about;
  std::size_t primitives = 0;
  double mesh_spacing = 0;             ///< scene units; 0: no mesh
  double read_s = 0, build_s = 0;      ///< the scene's text; surfaces
  double first_ray_s = 0;              ///< from the file to the first answer
  Cost first_frame;                    ///< while cells are made ready
  std::size_t cells = 0, blocks = 0;   ///< cells; those that the first frame's rays entered
  std::size_t bytes = 0;               ///< of the surfaces, after the first frame
  double largest_error = 0;            ///< certified bound of the traced field's error
  MaybeCost sample;                    ///< one further sample of each pixel in a whole render, film and light included
  Ratio sample_over_cones;             ///< `sample` over the frame of Embree's round cones
  std::vector<EngineFigures> engines;  ///< Marrow first
  std::vector<RuleFigures> rules;      ///< of `alpha`
  std::vector<ProcessFigures> processes;  ///< Marrow first
  std::vector<std::string> missing;       ///< what could not be compared, and why
};

/// `tell` hears what is being done, `found` each workload's figures as soon as they are there. When asked to stop it
/// returns the workloads that are finished, and leaves no temporary file. Errors: a workload of which Marrow makes no
/// scene, in the file of its name; a folder for temporary files that cannot be used.
Result<std::vector<WorkloadFigures>> run_benchmark(const std::vector<Workload>&, const BenchSettings&,
                                                   const std::function<void(const std::string&)>& tell,
                                                   const std::function<void(const WorkloadFigures&)>& found);

}  // namespace marrow
