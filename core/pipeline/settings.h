// Everything a user can set, in the user's units, before anything is derived from the model.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/mesh/region.h"
#include "core/pipeline/setting_value.h"
#include "core/reinforce/structural_optimizer.h"
#include "core/solidify/solidify.h"
#include "core/synthesis/synthesizer.h"

namespace fretwork {

/// Starting values for many keys at once; keys set by name win over the preset.
enum class Preset {
    kDraft,    ///< the coarse levels of the run that the same settings make without it, in seconds
    kDefault,  ///< the settings documented key by key
    kFine,     ///< 512 voxels along the longest side and a longer search
    kPaper,    ///< the paper's parameters and rules as printed
};

/// Which forces the structural steps design for.
enum class LoadProfile {
    kAuto,      ///< own loads where [[loads]] are given; else handling, or gravity under the paper's rules
    kGravity,   ///< self-weight on the lowest tenth
    kHandling,  ///< self-weight, pinching across three axes, pushes at the top
    kOwn,       ///< nothing but [[loads]] and [[fixtures]]
};

/// What colours the carved file carries.
enum class OutputColor {
    kExemplar,  ///< the picture's colours, per triangle
    kSolid,     ///< the mean colour of the picture's solid part everywhere
    kNone,
};

/// For which slicer triangles are painted with extruders.
enum class PaintFormat {
    kNone,
    kPrusa,  ///< PrusaSlicer's segmentation; read by OrcaSlicer and BambuStudio too
    kBambu,  ///< what OrcaSlicer and BambuStudio write themselves
};

/// An orientation of the picture on the surface: a direction it follows, or none.
struct OrientationChoice {
    Orientation mode = Orientation::kVector;
    Vec3 direction = Vec3::UnitZ();
    friend bool operator==(const OrientationChoice&, const OrientationChoice&) = default;
};

/// The axis of the model that points up when it is printed and held.
enum class UpAxis { kX, kY, kZ, kMinusX, kMinusY, kMinusZ };

struct InputOptions {
    UpAxis up = UpAxis::kZ;         ///< the model is turned so that this axis becomes z
    double scale = 1.0;             ///< factor on the model's coordinates
    std::optional<double> size_mm;  ///< longest side after scaling; instead of `scale`
    std::string objects = {};       ///< of a 3MF: names, numbers or part numbers, with commas between them
    bool ignore_required = false;   ///< of a 3MF: read on where an unknown extension is required
};

struct ExemplarOptions {
    std::string pattern;              ///< a built-in pattern by name
    std::string image;                ///< or a picture by path
    std::string mask;                 ///< picture whose light parts are solid
    std::optional<double> threshold;  ///< luma under which a pixel is solid
    bool alpha = false;               ///< opaque pixels are solid
    bool invert = false;
    std::optional<bool> tileable;
    std::optional<double> width_mm;  ///< real width of the picture on the surface
    int max_side_px = 1024;

    bool operator==(const ExemplarOptions&) const = default;
};

/// Voxels along the longest side where neither their number nor their size is asked for.
inline constexpr int kDefaultResolution = 256;

struct ShellOptions {
    std::optional<double> thickness_mm;
    std::optional<WallSide> side;
    std::optional<double> voxel_mm;
    std::optional<int> resolution;  ///< voxels along the longest side
    /// The run uses the grid's cells of 2^halvings voxels a side: the coarse part of the run without it.
    std::optional<int> halvings;
};

struct SynthesisOptions {
    Preset preset = Preset::kDefault;
    OrientationChoice orientation;
    double scale = 1.0;         ///< of the pattern; 2 makes everything twice as large
    std::optional<int> levels;  ///< of the pyramid
    /// Everything the synthesizer takes as it is; orientation and pixels per voxel are derived.
    SynthesisSettings search;
};

struct StructureOptions {
    std::string material = "PLA";
    std::optional<double> youngs_modulus_mpa;
    std::optional<double> poissons_ratio;
    std::optional<double> density_kg_m3;
    std::optional<double> strength_mpa;
    LoadProfile profile = LoadProfile::kAuto;
    Vec3 gravity = Vec3(0.0, 0.0, -1.0);
    double handling_force_n = 10.0;
    std::optional<double> drop_factor;     ///< weights that act at once when the object lands
    std::optional<double> drop_height_mm;  ///< or what it falls through, coming to rest over `drop_stop_mm`
    double drop_stop_mm = 2.0;
    int grips = 0;                 ///< pinches at places that face away from each other, a case each
    int weak_regions = 0;          ///< of the pattern, each a case: what it bears worst
    bool remove_supports = false;  ///< each case also without each of its supports
    double fixed_share = 0.1;
    std::optional<double> pattern_radius_mm;
    int verify_rounds = 0;  ///< full analyses after carving, each but the last followed by strengthening; 0: none
    /// Everything the optimizer takes as it is; thickness, radius and seed are derived.
    ReinforceSettings steps;
};

struct FabricationOptions {
    double nozzle_mm = 0.4;
    std::optional<double> min_feature_mm;
    std::optional<double> min_hole_mm;
    double simplify_voxels = 0.06;
    int target_triangles = 0;
    double layer_height_mm = 0.2;  ///< of the layers that printability is judged by
    double overhang_deg = 45.0;    ///< lean from the vertical that prints without support
};

struct OutputOptions {
    OutputColor colour = OutputColor::kExemplar;
    bool voxel_data = true;
    bool thumbnail = true;
    bool source = true;  ///< keep the model and the pictures in a 3MF
    PaintFormat paint = PaintFormat::kNone;
    int extruders = 4;
};

/// A region that pushes.
struct LoadOption {
    Region region;
    std::string load_case = "load";  ///< loads of one case act together
    Vec3 force_n = Vec3::Zero();
    double pressure_mpa = 0.0;
    double normal_force_n = 0.0;  ///< in all, into the surface along its normals
};

/// A region that holds.
struct FixtureOption {
    Region region;
    std::string load_case;  ///< empty: holds in every case
};

/// Settings of their own for some objects of a model.
struct ObjectOption {
    std::string match;                         ///< name, number or part number of the object
    std::vector<SettingAssignment> overrides;  ///< checked
};

/// The whole of a spec. Plain data: `settings_schema.h` knows names, ranges and help,
/// `resolve_settings.h` derives what the stages need.
struct Settings {
    InputOptions input;
    ExemplarOptions exemplar;
    ShellOptions shell;
    SynthesisOptions synthesis;
    StructureOptions structure;
    FabricationOptions fabrication;
    OutputOptions output;
    std::vector<Region> keep;   ///< stay solid
    std::vector<Region> carve;  ///< if any: only these are carved, all else stays solid
    std::vector<LoadOption> loads;
    std::vector<FixtureOption> fixtures;
    std::vector<ObjectOption> objects;
};

}  // namespace fretwork
