// The whole flow: mesh and picture in, carved mesh out. Algorithm 1 of the paper and the stages around it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/run_control.h"
#include "core/exemplar/exemplar.h"
#include "core/mesh/region.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pipeline/carve_trace.h"
#include "core/pipeline/run_report.h"
#include "core/pipeline/settings.h"
#include "core/shell/surface_voxels.h"
#include "core/solidify/solidify.h"

namespace fretwork {

struct CarveInput {
    TriangleMesh mesh;       ///< as it was read; `input.scale` and `input.size_mm` apply to it
    std::string model_name;  ///< for messages and the report
    Exemplar exemplar;
    std::optional<double> exemplar_width_mm;           ///< natural width of the exemplar, if it has one
    std::string exemplar_name;                         ///< for messages and the report
    std::vector<NamedTriangles> named_triangles = {};  ///< faces and parts of `mesh` that regions may name
    std::vector<Rgb8> triangle_colors = {};  ///< sRGB, one per triangle, or empty; regions that are kept show them
};

/// What this run may use. Does not change what comes out.
struct RunLimits {
    int threads = 0;                     ///< 0 = one per core
    std::uint64_t max_memory_bytes = 0;  ///< 0 = no limit
};

struct CarveResult {
    CarvedMesh carved;
    TriangleMesh surface;  ///< the repaired and scaled input, which `shell` was made from
    SurfaceVoxels shell;
    SolidStates solid;
    std::vector<std::uint8_t> reinforced;  ///< one byte per voxel: forced solid by the structural steps
    std::vector<Rgb8> voxel_colors;        ///< sRGB, one per voxel
    std::vector<float> stress_mpa;         ///< of the reinforced pattern, one per voxel; see StressField
    std::vector<std::uint16_t> labels;     ///< one per voxel; see label_patches.h
    std::optional<CarveTrace> trace;       ///< only if it was asked for
    RunReport report;
};

enum class KeepTrace { kNo, kYes };

/// Name and number of this version.
std::string version();

/// repair -> voxelise -> pyramid -> synthesise -> { structural step, resynthesise } -> enlarge -> solidify.
///
/// Promises  each connected component of the input becomes one connected component; the same arguments
///           give the same result for any number of threads; regions that are kept stay solid.
/// Progress  one rising fraction over all stages, ends at 1.
/// \param trace  whether to keep what a report shows; changes nothing else, costs some 10 bytes per voxel
/// \throws InvalidInput       the mesh or the picture cannot be used.
/// \throws InvalidSetting     a region or a name does not exist.
/// \throws ConstraintsNotMet  settings contradict each other or the model (`resolve_settings.h`).
/// \throws MemoryLimit        the estimate is over the limit; before anything large is made.
/// \throws Cancelled          `run` asked to stop.
CarveResult carve(const CarveInput& input, const Settings& settings, const RunLimits& limits = {},
                  const RunControl& run = {}, KeepTrace trace = KeepTrace::kNo);

/// What `carve` would stumble over or warn about, found without carving: what the numbers tell (`foresee.h`), and what
/// a draft of the run comes to. The numbers it would work with are in the report's shell and pattern, sentences in its
/// warnings, where those of the draft begin with "a draft".
///
/// Cost  under 5 s on two cores; models of over 400000 triangles go without the draft, and a warning says so.
/// \throws  as `carve`, except Cancelled within stages it does not run.
RunReport check_carve(const CarveInput& input, const Settings& settings, const RunLimits& limits = {},
                      const RunControl& run = {});

}  // namespace fretwork
