// The table itself. Each row names a member of Settings once; reading and writing follow from its type.
#include <array>
#include <concepts>
#include <type_traits>
#include <utility>

#include "core/base/error.h"
#include "core/pipeline/settings_schema.h"

namespace fretwork {
namespace {

// --- Names of enumerators -------------------------------------------------------------------------

template <class Enum>
struct Named {
    Enum value;
    const char* name;
};
template <class Enum>
Named(Enum, const char*) -> Named<Enum>;

constexpr std::array kPresetNames{Named{Preset::kDraft, "draft"}, Named{Preset::kDefault, "default"},
                                  Named{Preset::kFine, "fine"}, Named{Preset::kPaper, "paper"}};
constexpr std::array kProfileNames{Named{LoadProfile::kAuto, "auto"}, Named{LoadProfile::kGravity, "gravity"},
                                   Named{LoadProfile::kHandling, "handling"}, Named{LoadProfile::kOwn, "own"}};
constexpr std::array kColorNames{Named{OutputColor::kExemplar, "exemplar"}, Named{OutputColor::kSolid, "solid"},
                                 Named{OutputColor::kNone, "none"}};
constexpr std::array kPaintNames{Named{PaintFormat::kNone, "none"}, Named{PaintFormat::kPrusa, "prusa"},
                                 Named{PaintFormat::kBambu, "bambu"}};
constexpr std::array kSideNames{Named{WallSide::kInward, "inward"}, Named{WallSide::kOutward, "outward"},
                                Named{WallSide::kCentred, "centred"}};
constexpr std::array kUpNames{Named{UpAxis::kX, "x"},       Named{UpAxis::kY, "y"},       Named{UpAxis::kZ, "z"},
                              Named{UpAxis::kMinusX, "-x"}, Named{UpAxis::kMinusY, "-y"}, Named{UpAxis::kMinusZ, "-z"}};
constexpr std::array kRulesNames{Named{ReinforceRules::kDefault, "default"}, Named{ReinforceRules::kPaper, "paper"}};

const auto& names_of(Preset) {
    return kPresetNames;
}
const auto& names_of(LoadProfile) {
    return kProfileNames;
}
const auto& names_of(OutputColor) {
    return kColorNames;
}
const auto& names_of(PaintFormat) {
    return kPaintNames;
}
const auto& names_of(WallSide) {
    return kSideNames;
}
const auto& names_of(UpAxis) {
    return kUpNames;
}
const auto& names_of(ReinforceRules) {
    return kRulesNames;
}

// --- One member type <-> SettingValue -------------------------------------------------------------

template <class T>
struct Codec;

template <>
struct Codec<bool> {
    static constexpr SettingType type = SettingType::kBool;
    static SettingValue read(bool member) { return member; }
    static bool write(const SettingValue& value) { return std::get<bool>(value); }
};

template <std::integral T>
struct Codec<T> {
    static constexpr SettingType type = SettingType::kInteger;
    static SettingValue read(T member) { return static_cast<std::int64_t>(member); }
    static T write(const SettingValue& value) { return static_cast<T>(std::get<std::int64_t>(value)); }
};

template <>
struct Codec<double> {
    static constexpr SettingType type = SettingType::kNumber;
    static SettingValue read(double member) { return member; }
    static double write(const SettingValue& value) { return std::get<double>(value); }
};

template <>
struct Codec<std::string> {
    static constexpr SettingType type = SettingType::kText;
    static SettingValue read(const std::string& member) { return member; }
    static std::string write(const SettingValue& value) { return std::get<std::string>(value); }
};

template <>
struct Codec<Vec3> {
    static constexpr SettingType type = SettingType::kDirection;
    static SettingValue read(const Vec3& member) { return std::vector<double>{member[0], member[1], member[2]}; }
    static Vec3 write(const SettingValue& value) { return Vec3(std::get<std::vector<double>>(value).data()); }
};

template <>
struct Codec<OrientationChoice> {
    static constexpr SettingType type = SettingType::kOrientation;
    static SettingValue read(const OrientationChoice& member) {
        if (member.mode == Orientation::kFree) return std::string("free");
        if (member.direction == Vec3(Vec3::UnitZ())) return std::string("up");
        return Codec<Vec3>::read(member.direction);
    }
    static OrientationChoice write(const SettingValue& value) {
        if (const auto* name = std::get_if<std::string>(&value))
            return {*name == "free" ? Orientation::kFree : Orientation::kVector, Vec3::UnitZ()};
        return {Orientation::kVector, Codec<Vec3>::write(value)};
    }
};

template <class T>
requires std::is_enum_v<T>
struct Codec<T> {
    static constexpr SettingType type = SettingType::kChoice;
    static SettingValue read(T member) {
        for (const auto& named : names_of(T{}))
            if (named.value == member) return std::string(named.name);
        return std::string{};
    }
    static T write(const SettingValue& value) {
        for (const auto& named : names_of(T{}))
            if (named.name == std::get<std::string>(value)) return named.value;
        throw InvalidSetting("no such choice: " + std::get<std::string>(value));
    }
};

template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};

// --- Rows -----------------------------------------------------------------------------------------

// `member` returns a reference into the Settings it is given.
template <class Member>
SettingInfo row(std::string key, Member member, std::string unit, std::optional<SettingRange> range, std::string help,
                std::string when_unset = {}) {
    using Raw = std::remove_cvref_t<decltype(member(std::declval<Settings&>()))>;
    SettingInfo info;
    info.key = std::move(key);
    info.unit = std::move(unit);
    info.range = range;
    info.help = std::move(help);
    info.when_unset = std::move(when_unset);
    const auto describe = [&]<class T>(std::type_identity<T>) {
        info.type = Codec<T>::type;
        if constexpr (std::is_enum_v<T>)
            for (const auto& named : names_of(T{})) info.choices.emplace_back(named.name);
    };
    if constexpr (IsOptional<Raw>::value) {
        using T = typename Raw::value_type;
        describe(std::type_identity<T>{});
        info.get = [member](const Settings& s) -> std::optional<SettingValue> {
            const Raw& value = member(const_cast<Settings&>(s));
            if (!value) return std::nullopt;
            return Codec<T>::read(*value);
        };
        info.set = [member](Settings& s, const SettingValue& value) { member(s) = Codec<T>::write(value); };
    } else {
        describe(std::type_identity<Raw>{});
        const bool unset_when_empty = !info.when_unset.empty();
        info.get = [member, unset_when_empty](const Settings& s) -> std::optional<SettingValue> {
            const Raw& value = member(const_cast<Settings&>(s));
            if (unset_when_empty)
                if constexpr (std::is_same_v<Raw, std::string>)
                    if (value.empty()) return std::nullopt;
            return Codec<Raw>::read(value);
        };
        info.set = [member](Settings& s, const SettingValue& value) { member(s) = Codec<Raw>::write(value); };
    }
    return info;
}

constexpr SettingRange between(double min, double max) {
    return {min, max, false};
}
constexpr SettingRange above(double min, double max) {
    return {min, max, true};
}

// The argument is the name of a member. NOLINTBEGIN(bugprone-macro-parentheses)
#define FIELD(path)             \
    [](Settings & s) -> auto& { \
        return s.path;          \
    }
// NOLINTEND(bugprone-macro-parentheses)

void add_input(std::vector<SettingInfo>& t) {
    t.push_back(row("input.up", FIELD(input.up), "1", {},
                    "Axis of the model that points up; the model is turned so that it becomes z. Regions and forces "
                    "refer to the turned model."));
    t.push_back(row("input.scale", FIELD(input.scale), "1", above(0, 1e6), "Factor on the model's coordinates."));
    t.push_back(row("input.size_mm", FIELD(input.size_mm), "mm", between(5, 5000),
                    "Longest side of the model; scales it. Instead of input.scale.", "the model's own size"));
    t.push_back(row("input.objects", FIELD(input.objects), "1", {},
                    "Objects of a 3MF to carve, by name, number or part number, with commas between them.",
                    "all that are printed"));
    t.push_back(row("input.ignore_required", FIELD(input.ignore_required), "1", {},
                    "Carve a 3MF although it requires an extension that is not known; what that says is kept."));
}

void add_exemplar(std::vector<SettingInfo>& t) {
    t.push_back(row("exemplar.pattern", FIELD(exemplar.pattern), "1", {},
                    "Name of a built-in pattern (see `fretwork pattern list`). Instead of exemplar.image.",
                    "none; give a pattern or an image"));
    t.push_back(row("exemplar.image", FIELD(exemplar.image), "1", {},
                    "Picture of the pattern, PNG or JPEG; relative to the spec.", "none; give a pattern or an image"));
    t.push_back(row("exemplar.mask", FIELD(exemplar.mask), "1", {},
                    "Picture of what is solid: light is solid. Relative to the spec.",
                    "the alpha channel if it varies, else an automatic cut: dark is solid"));
    t.push_back(row("exemplar.threshold", FIELD(exemplar.threshold), "1", between(0, 1),
                    "Pixels darker than this are solid. Instead of a mask.", "see exemplar.mask"));
    t.push_back(row("exemplar.alpha", FIELD(exemplar.alpha), "1", {}, "Opaque pixels are solid. Instead of a mask."));
    t.push_back(row("exemplar.invert", FIELD(exemplar.invert), "1", {}, "Exchange solid and empty."));
    t.push_back(row("exemplar.tileable", FIELD(exemplar.tileable), "1", {},
                    "Whether the picture continues across its borders.", "decided from the step across the border"));
    t.push_back(row("exemplar.width_mm", FIELD(exemplar.width_mm), "mm", between(0.5, 5000),
                    "Real width of the picture on the surface.",
                    "a built-in pattern's own, else 256 pixels to the longest side; a fifth to a half of that side"));
    t.push_back(row("exemplar.max_side_px", FIELD(exemplar.max_side_px), "px", between(16, 4096),
                    "Larger pictures are reduced to this first."));
}

void add_shell(std::vector<SettingInfo>& t) {
    t.push_back(row("shell.thickness_mm", FIELD(shell.thickness_mm), "mm", above(0, 1000),
                    "Thickness of the carved wall; at least two voxels.",
                    "2 % of the longest side, at least 2.5 voxels and 1.2 mm"));
    t.push_back(row("shell.side", FIELD(shell.side), "1", {},
                    "To which side of the model's surface the wall grows; open surfaces need centred.",
                    "inward; centred for open surfaces"));
    t.push_back(row("shell.voxel_mm", FIELD(shell.voxel_mm), "mm", above(0, 100),
                    "Side of a voxel. Instead of shell.resolution.", "from shell.resolution"));
    t.push_back(row("shell.resolution", FIELD(shell.resolution), "voxels", between(8, 2048),
                    "Voxels along the longest side.", "256, or from shell.voxel_mm"));
    t.push_back(row("shell.halvings", FIELD(shell.halvings), "1", between(0, 6),
                    "Halvings of that resolution: the run stops on a coarser level of the grid and shows the large "
                    "features of the full one.",
                    "0; in a draft as many as it takes to answer in about 2 s"));
}

void add_synthesis(std::vector<SettingInfo>& t) {
    t.push_back(row("synthesis.preset", FIELD(synthesis.preset), "1", {},
                    "Starting values for many keys: speed, quality, or the paper's own parameters."));
    t.push_back(row("synthesis.seed", FIELD(synthesis.search.seed), "1", between(0, 9.2e18),
                    "Another number gives another arrangement of the same pattern."));
    t.push_back(row("synthesis.orientation", FIELD(synthesis.orientation), "1", {},
                    "Where the picture's up points on the surface: \"up\", \"free\" or a direction [x, y, z]."));
    t.push_back(row("synthesis.symmetric", FIELD(synthesis.search.symmetric), "1", {},
                    "Up and down of the picture are the same."));
    t.push_back(row("synthesis.orientation_smoothing", FIELD(synthesis.search.orientation_smoothing), "1",
                    between(0, 1),
                    "Length over which that direction is evened out, in longest sides; 0 = projected as it is."));
    t.push_back(row("synthesis.scale", FIELD(synthesis.scale), "1", between(0.1, 20),
                    "Size of the pattern against its normal size."));
    t.push_back(row("synthesis.jitter", FIELD(synthesis.search.jitter), "1", between(0, 1),
                    "Share of voxels relabelled at random on coarse levels."));
    t.push_back(row("synthesis.jitter_from_level", FIELD(synthesis.search.jitter_from_level), "1", between(0, 12),
                    "Finest level on which labels are jittered; 0 = all."));
    t.push_back(row("synthesis.candidates", FIELD(synthesis.search.candidates), "1", between(1, 256),
                    "Labels tried per voxel and pass, copied and random ones together."));
    t.push_back(row("synthesis.fine_random_candidates", FIELD(synthesis.search.fine_random_candidates), "1",
                    between(0, 256), "Random ones among them on the two finest levels."));
    t.push_back(row("synthesis.transported", FIELD(synthesis.search.transported), "1", between(0, 64),
                    "Copied labels that are turned to the voxel's own best plane."));
    t.push_back(row("synthesis.count_repeated", FIELD(synthesis.search.count_repeated), "1", {},
                    "Neighbours that agree use up one candidate each, as in the paper."));
    t.push_back(row("synthesis.directions", FIELD(synthesis.search.directions), "1", between(6, 4096),
                    "Projection planes; 26 gives the paper's set."));
    t.push_back(row("synthesis.rotations", FIELD(synthesis.search.rotations), "1", between(1, 4096),
                    "Rotations of the picture in each plane."));
    t.push_back(row("synthesis.translations", FIELD(synthesis.search.translations), "1", between(0, 1024),
                    "Shifts of the picture per axis; 0 = continuous."));
    t.push_back(row("synthesis.cone_deg", FIELD(synthesis.search.cone_deg), "deg", between(0, 90),
                    "Random planes lie within this angle of the surface normal."));
    t.push_back(row("synthesis.distortion_weight", FIELD(synthesis.search.distortion_weight), "1", between(0, 100),
                    "Weight of foreshortening against colour."));
    t.push_back(row("synthesis.orientation_weight", FIELD(synthesis.search.orientation_weight), "1", between(0, 100),
                    "Weight of the wanted orientation against colour."));
    t.push_back(row("synthesis.border_weight", FIELD(synthesis.search.border_weight), "1", between(0, 100),
                    "Penalty of places near the border of a picture that does not tile."));
    t.push_back(row("synthesis.border_band", FIELD(synthesis.search.border_band), "1", between(0, 0.4),
                    "What counts as near that border, as a share of the side."));
    t.push_back(row("synthesis.feature_weight", FIELD(synthesis.search.feature_weight), "1", between(0, 1),
                    "Weight of the distance to the solid's border against one colour channel."));
    t.push_back(row("synthesis.normalize_energy", FIELD(synthesis.search.normalize_energy), "1", {},
                    "Divide the colour energy by the number of neighbours."));
    t.push_back(row("synthesis.coarse_passes", FIELD(synthesis.search.coarse_passes), "1", between(1, 64),
                    "Most passes on a coarse level; finer ones get half each."));
    t.push_back(row("synthesis.random_start", FIELD(synthesis.search.random_start), "1", {},
                    "Start from random labels instead of one label everywhere."));
    t.push_back(row("synthesis.levels", FIELD(synthesis.levels), "1", between(1, 12), "Levels of the voxel pyramid.",
                    "one per halving of the resolution"));
}

void add_structure(std::vector<SettingInfo>& t) {
    t.push_back(row("structure.rules", FIELD(structure.steps.rules), "1", {},
                    "Order and thresholds of the reinforcement: Fretwork's own or the paper's."));
    t.push_back(row("structure.material", FIELD(structure.material), "1", {},
                    "What it is printed from: PLA, PETG, ABS, PA12 or resin."));
    t.push_back(row("structure.youngs_modulus_mpa", FIELD(structure.youngs_modulus_mpa), "MPa", above(0, 1e6),
                    "Stiffness (Young's modulus).", "from structure.material"));
    t.push_back(row("structure.poissons_ratio", FIELD(structure.poissons_ratio), "1", between(0, 0.49),
                    "Poisson's ratio.", "from structure.material"));
    t.push_back(row("structure.density_kg_m3", FIELD(structure.density_kg_m3), "kg/m3", above(0, 30000),
                    "Weight per volume of the material.", "from structure.material"));
    t.push_back(row("structure.strength_mpa", FIELD(structure.strength_mpa), "MPa", above(0, 1e4),
                    "Strength across the printed layers.", "from structure.material"));
    t.push_back(row("structure.safety_factor", FIELD(structure.steps.safety_factor), "1", between(1, 100),
                    "Allowable stress = strength / this."));
    t.push_back(row("structure.profile", FIELD(structure.profile), "1", {},
                    "Forces to withstand; auto takes [[loads]] where given, else handling."));
    t.push_back(row("structure.gravity", FIELD(structure.gravity), "1", {},
                    "Direction in which the object's weight pulls, [x, y, z]."));
    t.push_back(
        row("structure.handling_force_n", FIELD(structure.handling_force_n), "N", above(0, 10000),
            "Force of each finger that pinches or pushes: of the handling profile, of grips; half of a worst case."));
    t.push_back(row("structure.drop_factor", FIELD(structure.drop_factor), "1", between(1, 1e5),
                    "One more case: the object lands on what holds it, under this many times its weight.",
                    "from structure.drop_height_mm, else no such case"));
    t.push_back(row("structure.drop_height_mm", FIELD(structure.drop_height_mm), "mm", above(0, 1e5),
                    "Height it falls from, instead of structure.drop_factor, which becomes 1 + height / stop.",
                    "not dropped"));
    t.push_back(row("structure.drop_stop_mm", FIELD(structure.drop_stop_mm), "mm", above(0, 1000),
                    "Way over which it comes to rest after structure.drop_height_mm."));
    t.push_back(row("structure.grips", FIELD(structure.grips), "1", between(0, 64),
                    "So many more cases: two fingers pinch it at opposite places spread over the surface."));
    t.push_back(row("structure.weak_regions", FIELD(structure.weak_regions), "1", between(0, 32),
                    "So many more cases, without knowing the load: for each of the weakest regions of the pattern the "
                    "pressure, as strong in all as a pinch, that it bears worst."));
    t.push_back(row("structure.remove_supports", FIELD(structure.remove_supports), "1", {},
                    "Each case also without each of its supports in turn: [[fixtures]], else feet it stands on."));
    t.push_back(row("structure.fixed_share", FIELD(structure.fixed_share), "1", above(0, 0.9),
                    "Lowest share of the height that is held where no [[fixtures]] are given."));
    t.push_back(row("structure.geodesic_factor", FIELD(structure.steps.geodesic_factor), "1", between(0, 100),
                    "Longest way around through solid, in extents of the object; 0 = any."));
    t.push_back(row("structure.pattern_radius_mm", FIELD(structure.pattern_radius_mm), "mm", above(0, 100),
                    "Half the width of a bridge.", "half a stroke of the exemplar, at least 1.5 voxels"));
    t.push_back(row("structure.samples", FIELD(structure.steps.samples), "1", between(10, 20000),
                    "Vertices of the abstract graph; the paper uses 500 to 1000."));
    t.push_back(row("structure.soft_factor", FIELD(structure.steps.soft_factor), "1", between(1e-9, 1),
                    "Stiffness of empty edges against solid ones."));
    t.push_back(row("structure.stress_ratio", FIELD(structure.steps.stress_ratio), "1", between(1, 1000),
                    "Stress at which reinforcing stops, in medians."));
    t.push_back(row("structure.material_budget", FIELD(structure.steps.material_budget), "1", between(0, 1),
                    "Most voxels added against stress, as a share of the shell."));
    t.push_back(row("structure.batch", FIELD(structure.steps.batch), "1", between(1, 1000),
                    "Bridges between two solutions of the equations."));
    t.push_back(row("structure.max_iterations", FIELD(structure.steps.max_iterations), "1", between(1, 1000),
                    "Most turns of the loop of reinforcement and resynthesis."));
    t.push_back(row("structure.verify_rounds", FIELD(structure.verify_rounds), "1", between(0, 50),
                    "Rounds in which the result is analysed in full and strengthened where weak; 0 = none."));
}

void add_fabrication(std::vector<SettingInfo>& t) {
    t.push_back(row("fabrication.nozzle_mm", FIELD(fabrication.nozzle_mm), "mm", between(0.01, 5),
                    "Width of a printed line; other widths follow from it."));
    t.push_back(row("fabrication.min_feature_mm", FIELD(fabrication.min_feature_mm), "mm", above(0, 100),
                    "Least width of solid features.", "two nozzles, at least 2 voxels"));
    t.push_back(row("fabrication.min_hole_mm", FIELD(fabrication.min_hole_mm), "mm", above(0, 100),
                    "Least width of holes.", "two nozzles, at least 0.9 voxels"));
    t.push_back(row("fabrication.simplify_voxels", FIELD(fabrication.simplify_voxels), "voxels", between(0, 1),
                    "How far simplifying may move the surface; 0 keeps every triangle."));
    t.push_back(row("fabrication.target_triangles", FIELD(fabrication.target_triangles), "1", between(0, 1e8),
                    "Most triangles wanted; 0 = as the tolerance allows."));
    t.push_back(row("fabrication.layer_height_mm", FIELD(fabrication.layer_height_mm), "mm", between(0.01, 10),
                    "Height of the layers that the report on printability looks at."));
    t.push_back(row("fabrication.overhang_deg", FIELD(fabrication.overhang_deg), "degrees", between(0, 89),
                    "Lean from the vertical that prints without support."));
}

void add_output(std::vector<SettingInfo>& t) {
    t.push_back(row("output.colour", FIELD(output.colour), "1", {},
                    "Colours in the file: the picture's, its solid part's mean, or none."));
    t.push_back(
        row("output.voxel_data", FIELD(output.voxel_data), "1", {}, "Write the voxel grid into a 3MF as well."));
    t.push_back(row("output.thumbnail", FIELD(output.thumbnail), "1", {}, "Put a picture of the result into a 3MF."));
    t.push_back(row("output.source", FIELD(output.source), "1", {},
                    "Keep the model and the pictures in a 3MF, so that it can be carved again from itself."));
    t.push_back(row("output.paint", FIELD(output.paint), "1", {},
                    "Paint the triangles of a 3MF with extruders, for PrusaSlicer or for BambuStudio and OrcaSlicer."));
    t.push_back(row("output.extruders", FIELD(output.extruders), "1", between(1, 16),
                    "Extruders to paint with; colours are brought down to as many."));
}

#undef FIELD

}  // namespace

std::span<const SettingInfo> all_settings() {
    static const std::vector<SettingInfo> table = [] {
        std::vector<SettingInfo> t;
        add_input(t);
        add_exemplar(t);
        add_shell(t);
        add_synthesis(t);
        add_structure(t);
        add_fabrication(t);
        add_output(t);
        return t;
    }();
    return table;
}

}  // namespace fretwork
