// One pattern on one model, up to and including the loop of Algorithm 1: what the likeness benchmark looks at.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/exemplar/exemplar.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pipeline/settings.h"
#include "core/pyramid/voxel_pyramid.h"
#include "likeness/surface_windows.h"

namespace fretwork::bench {

/// A model, made into a shell once.
struct BenchModel {
    std::string name;
    TriangleMesh mesh;
    SurfaceVoxels shell;
    VoxelPyramid pyramid;
    bool open = false;
    int resolution = 0;
};

/// \param mesh  scaled to 100 mm along its longest side
BenchModel make_model(std::string name, TriangleMesh mesh, int resolution, bool open);
/// An upright square.
BenchModel make_plate(int resolution);

/// An exemplar and the picture that outputs are compared with.
struct BenchExemplar {
    std::string name;
    Exemplar exemplar;
    likeness::PatternPicture reference;  ///< at one pixel per voxel
    likeness::PatternPixel solid_mean;   ///< mean of its solid part, which bridges are painted with
};

/// The picture is shown at one pixel per voxel, and reduced to 128 across if it is wider.
BenchExemplar make_bench_exemplar(std::string name, Exemplar exemplar);

enum class WithStructure { kNo, kYes };

struct PatternRun {
    likeness::ShownPattern first;  ///< after SYNTHESIZE
    double solid_fraction = 0.0;   ///< of it
    // With structure only:
    likeness::ShownPattern painted;        ///< `first` with the bridges of all turns painted over it
    likeness::ShownPattern resynthesized;  ///< as the loop left it
    double solid_fraction_after = 0.0;
    std::size_t turns = 0;
    double seconds_first = 0.0, seconds_structure = 0.0;
};

/// \param settings  a preset, a seed, and whatever is tried; the picture's size on the surface is set here
PatternRun run_pattern(const BenchModel& model, const BenchExemplar& exemplar, Settings settings,
                       WithStructure structure);

/// Marks where the final states differ from what the labels show.
std::vector<likeness::ShownPattern::Over> where_states_differ(const SolidStates& shown, const SolidStates& states);

/// The plate from the front.
likeness::PatternPicture plate_picture(const BenchModel& plate, const likeness::ShownPattern& pattern,
                                       const likeness::PatternPicture& reference);

}  // namespace fretwork::bench
