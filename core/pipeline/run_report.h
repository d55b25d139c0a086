// What a run was asked, did and found. `formats/report_json.h` writes it, docs/report.schema.json describes it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh/mesh_report.h"
#include "core/pipeline/setting_value.h"
#include "core/pipeline/settings.h"
#include "core/pipeline/strength_check.h"
#include "core/printability/printability.h"
#include "core/reinforce/structural_optimizer.h"

namespace fretwork {

/// The model as it came in, after scaling.
struct InputRecord {
    std::string model;     ///< as the caller names it: a path, an object
    std::string exemplar;  ///< a path or the name of a built-in pattern
    double scale = 1.0;    ///< factor that was applied
    MeshReport mesh;
};

struct ShellRecord {
    int resolution = 0;
    double voxel_mm = 0.0;
    std::size_t surface_voxels = 0;
    std::size_t components = 0;
    double thickness_mm = 0.0;
};

struct PatternRecord {
    double exemplar_width_mm = 0.0;
    double pixels_per_voxel = 0.0;
    double exemplar_solid_fraction = 0.0;
    std::size_t solid_voxels = 0;  ///< of the final pattern
    double solid_fraction = 0.0;
    std::size_t reinforced_voxels = 0;  ///< forced solid by the structural steps
    std::size_t kept_voxels = 0;        ///< in regions that stay solid
    std::size_t components_before = 0;  ///< pieces of the first synthesis
    std::size_t components_after = 0;   ///< pieces of the final pattern
    std::size_t voxels_enlarged = 0;
    std::size_t voxels_filled = 0;
    std::size_t islands_dropped = 0;
    std::size_t islands_joined = 0;
};

/// Scores of the last turn, over solid edges of the abstract graph.
struct StructureRecord {
    double max_pa = 0.0;
    double average_pa = 0.0;
    double median_pa = 0.0;
    double p99_pa = 0.0;
    double allowable_pa = 0.0;
    std::string verdict;     ///< "within the allowable stress", "over the allowable stress by a factor of 1.7"
    std::string stopped_by;  ///< why the loop ended
};

/// One full analysis, and what was done about what it found weak.
struct StrengthRound {
    double least_factor = 0.0;     ///< of safety
    std::size_t weak_voxels = 0;   ///< of the surface, below the asked factor
    std::size_t voxels_added = 0;  ///< made solid for the next round
};

/// Of the full analysis of the result, where it was asked for.
struct StrengthRecord {
    std::vector<StrengthRound> rounds;  ///< the first is of the object as the loop of Algorithm 1 left it
    StrengthCheck check;                ///< of the result, without its values per voxel
    std::vector<std::string> faults;    ///< see strength_faults.h
    std::string stopped_by;             ///< "holds", "rounds", "budget", "nothing to fill", "no gain"
};

struct OutputMeshRecord {
    MeshReport report;
    double min_feature_mm = 0.0;  ///< width that every solid feature was brought to
    double min_hole_mm = 0.0;     ///< width that every hole was brought to
    std::size_t islands_removed = 0;
    double islands_volume_mm3 = 0.0;
};

/// Colours that stand for the extruders triangles are painted with; none where nothing is painted.
struct PaintRecord {
    PaintFormat format = PaintFormat::kNone;
    std::vector<Rgb8> extruders;  ///< sRGB, of extruder 1, 2 ...
};

struct StageSeconds {
    std::string stage;
    double seconds = 0.0;  ///< wall clock
};

/// By layers; what a draft does without.
struct PrintRecord {
    PrintabilityReport report;
    std::vector<std::string> faults;  ///< see print_faults.h
};

/// What a slicer made of the result. Only with `--slice`, and never in the carved file itself.
struct SliceRecord {
    std::string slicer, profile, output;
    std::size_t layers = 0;
    double height_mm = 0.0;                                               ///< of the last layer
    std::optional<double> seconds, filament_mm, filament_g, material_ml;  ///< as the slicer estimates
    bool parts_compared = false;  ///< whether every part of every layer was looked for
    std::size_t lost_parts = 0;   ///< that no line is printed in
    std::vector<std::string> warnings, faults;
};

struct RunReport {
    std::string version;
    InputRecord input;
    std::vector<SettingAssignment> settings;  ///< every key, with what it resolved to
    std::vector<SettingTable> regions;
    std::uint64_t seed = 0;
    ShellRecord shell;
    PatternRecord pattern;
    std::vector<ReinforceRecord> iterations;
    StructureRecord structure;
    std::optional<StrengthRecord> strength;
    OutputMeshRecord mesh;
    std::optional<PrintRecord> print;
    PaintRecord paint;
    std::optional<SliceRecord> slicing;
    std::vector<StageSeconds> seconds;  ///< in the order of the run
    double seconds_total = 0.0;
    double seconds_resynthesis = 0.0;  ///< part of "reinforce"
    std::uint64_t peak_memory_bytes = 0;
    std::vector<std::string> warnings;
};

}  // namespace fretwork
