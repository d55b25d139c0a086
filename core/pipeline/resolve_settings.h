// The user's settings -> each stage's settings, with everything derived that was left open.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/enlarge/enlarge_features.h"
#include "core/exemplar/exemplar.h"
#include "core/fem/material.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pipeline/settings.h"
#include "core/shell/voxelize.h"

namespace fretwork {

/// The numbers a run works with. All lengths are those of the scaled model.
struct ResolvedSettings {
    double longest_side_mm = 0.0;
    double voxel_mm = 0.0;
    double exemplar_width_mm = 0.0;
    int pyramid_levels = 1;
    VoxelizeSettings voxelize;  ///< with `halvings`: all lengths in voxels are in voxels of the coarser grid
    SynthesisSettings synthesis;
    Material material;
    ReinforceSettings reinforce;
    EnlargeSettings enlarge;
    SolidifySettings solidify;
    std::vector<std::string> warnings;
};

/// What a run's numbers depend on besides the settings: the scaled model ...
struct SurfaceFacts {
    double longest_side_mm = 0.0;
    bool open = false;      ///< has border edges
    double area_mm2 = 0.0;  ///< of the surface; decides how coarse a draft must be
};

/// ... and the exemplar.
struct ExemplarFacts {
    int width_px = 0;
    double half_stroke_px = 1.0;             ///< half the width of a typical solid stroke
    std::optional<double> natural_width_mm;  ///< of a built-in pattern
    double half_gap_px = 1.0;                ///< half the width of a typical opening
};

/// \param natural_width_mm  see ExemplarFacts
ExemplarFacts exemplar_facts(const Exemplar& exemplar, std::optional<double> natural_width_mm = {});

/// The factor on the model's coordinates that `input.scale` or `input.size_mm` asks for.
/// \throws ConstraintsNotMet  both are given, or the scaled longest side lies outside [5, 5000] mm: files
///                            without units are often in metres or inches.
double input_scale(const TriangleMesh& mesh, const InputOptions& input);

/// \throws ConstraintsNotMet  two values contradict each other; the message names both and one that works.
/// \throws InvalidSetting     an unknown material.
ResolvedSettings resolve_settings(const Settings& settings, const SurfaceFacts& surface, const ExemplarFacts& exemplar);

/// The material that the settings describe: that of the table with the values of its own on top.
/// \throws InvalidSetting  an unknown name
Material material_of(const StructureOptions& structure);

/// Longest side of the bounding box, in the mesh's units.
/// \throws InvalidInput  no vertex, or a coordinate that is not finite.
double longest_side(const TriangleMesh& mesh);

}  // namespace fretwork
