#include "core/pipeline/resolve_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/base/error.h"
#include "core/pipeline/settings_schema.h"

namespace fretwork {
namespace {

constexpr double kLeastSideMm = 5.0, kMostSideMm = 5000.0;
constexpr double kLeastWallVoxels = 2.0, kLeastRadiusVoxels = 1.5;
// A width that is a whole number of voxels may come out a rounding error below it.
constexpr double kSlack = 1.0 - 1e-9;

int resolution_for(double longest_side_mm, double voxel_mm) {
    return static_cast<int>(std::ceil(longest_side_mm / voxel_mm * kSlack));
}

int choose_resolution(const ShellOptions& shell, double longest_side_mm) {
    if (shell.resolution && shell.voxel_mm)
        throw ConstraintsNotMet(
            fmt::format("shell.resolution = {} and shell.voxel_mm = {:g} name the same thing; leave one out "
                        "(shell.voxel_mm = {:g} is what the resolution gives)",
                        *shell.resolution, *shell.voxel_mm, longest_side_mm / *shell.resolution));
    if (!shell.voxel_mm) return shell.resolution.value_or(kDefaultResolution);
    const SettingRange range = *setting_info("shell.resolution").range;
    const double voxels = longest_side_mm / *shell.voxel_mm;
    if (voxels < range.min || voxels > range.max)
        throw ConstraintsNotMet(fmt::format(
            "shell.voxel_mm = {:g} on a model of {:g} mm makes {:.0f} voxels; use {:g} to {:g} mm", *shell.voxel_mm,
            longest_side_mm, voxels, longest_side_mm / range.max, longest_side_mm / range.min));
    return resolution_for(longest_side_mm, *shell.voxel_mm);
}

// A draft works on the finest level of the full run's grid that has few enough voxels to answer while one waits.
int choose_halvings(const Settings& settings, const SurfaceFacts& surface, const ResolvedSettings& r) {
    if (settings.shell.halvings) return *settings.shell.halvings;
    if (settings.synthesis.preset != Preset::kDraft) return 0;
    constexpr double most_faces = 14000.0;  // of cells, as many as cover the surface
    constexpr int least_resolution = 48;
    int halvings = 0;
    double voxel_mm = r.voxel_mm;
    while (surface.area_mm2 > most_faces * voxel_mm * voxel_mm &&
           r.voxelize.resolution >> (halvings + 1) >= least_resolution) {
        ++halvings;
        voxel_mm *= 2.0;
    }
    return halvings;
}

// The printed rules know a surface, and nothing of walls that meet behind it.
double inner_wall_mm(ReinforceRules rules, const SolidifySettings& wall) {
    if (rules == ReinforceRules::kPaper || wall.side == WallSide::kOutward) return 0.0;
    return wall.side == WallSide::kCentred ? 0.5 * wall.thickness_mm : wall.thickness_mm;
}

// Goes over to the coarser grid. What the settings ask for was checked against the grid that they name; here a wall
// that the coarser one cannot hold grows to one that it can.
void coarsen(int halvings, ResolvedSettings& r) {
    r.voxelize.halvings = halvings;
    r.synthesis.skipped_levels = halvings;
    r.pyramid_levels = std::max(1, r.pyramid_levels - halvings);
    const double factor = std::ldexp(1.0, halvings);
    r.voxel_mm *= factor;
    r.synthesis.pixels_per_voxel *= factor;
    r.reinforce.pattern_radius_voxels = std::max(r.reinforce.pattern_radius_voxels / factor, kLeastRadiusVoxels);
    r.solidify.thickness_mm = std::max(r.solidify.thickness_mm, kLeastWallVoxels * r.voxel_mm);
    r.reinforce.thickness_mm = r.solidify.thickness_mm;
    r.reinforce.inner_wall_mm = inner_wall_mm(r.reinforce.rules, r.solidify);
    // Thin strokes grown to two coarse voxels would show a wall with a few holes instead of the pattern.
    r.enlarge.draft = true;
}

double wall_thickness(const Settings& settings, const ResolvedSettings& r) {
    if (!settings.shell.thickness_mm)
        return std::max({0.02 * r.longest_side_mm, 2.5 * r.voxel_mm, 3.0 * settings.fabrication.nozzle_mm});
    const double thickness = *settings.shell.thickness_mm;
    if (thickness < kLeastWallVoxels * r.voxel_mm * kSlack)
        throw ConstraintsNotMet(
            fmt::format("shell.thickness_mm = {:g} is under two voxels of {:g} mm; use a thickness of {:.4g} mm or "
                        "shell.resolution = {}",
                        thickness, r.voxel_mm, kLeastWallVoxels * r.voxel_mm,
                        resolution_for(r.longest_side_mm, thickness / kLeastWallVoxels)));
    if (thickness > 0.5 * r.longest_side_mm)
        throw ConstraintsNotMet(
            fmt::format("shell.thickness_mm = {:g} is over half of the model's {:g} mm; use at most {:g}", thickness,
                        r.longest_side_mm, 0.5 * r.longest_side_mm));
    return thickness;
}

// A width of features or holes: what was asked, if it can be resolved and printed, else the default.
double printable_width(const std::optional<double>& asked, const char* key, double least_voxels,
                       const FabricationOptions& fabrication, const ResolvedSettings& r) {
    const double least_mm = least_voxels * r.voxel_mm;
    if (!asked) return std::max(2.0 * fabrication.nozzle_mm, least_mm);
    if (*asked < fabrication.nozzle_mm)
        throw ConstraintsNotMet(fmt::format("{} = {:g} is under fabrication.nozzle_mm = {:g}; use {:g} or more", key,
                                            *asked, fabrication.nozzle_mm, fabrication.nozzle_mm));
    if (*asked < least_mm * kSlack)
        throw ConstraintsNotMet(
            fmt::format("{} = {:g} is under {:g} voxels of {:g} mm; use {:.4g} or shell.resolution = {}", key, *asked,
                        least_voxels, r.voxel_mm, least_mm, resolution_for(r.longest_side_mm, *asked / least_voxels)));
    if (*asked > 0.5 * r.longest_side_mm)
        throw ConstraintsNotMet(fmt::format("{} = {:g} is over half of the model's {:g} mm; use at most {:g}", key,
                                            *asked, r.longest_side_mm, 0.5 * r.longest_side_mm));
    return *asked;
}

// Without a width, the picture keeps its size when the resolution changes: resolution is a matter of
// quality, not of design. At the default resolution a pixel is a voxel.
double exemplar_width(const Settings& settings, const ResolvedSettings& r, const ExemplarFacts& exemplar) {
    const double scale = settings.synthesis.scale;
    const double pixel_is_voxel = r.longest_side_mm * exemplar.width_px / kDefaultResolution;
    const double natural = std::clamp(exemplar.natural_width_mm.value_or(pixel_is_voxel), 0.2 * r.longest_side_mm,
                                      0.5 * r.longest_side_mm);
    const double width = settings.exemplar.width_mm.value_or(natural) * scale;
    const std::string named = settings.exemplar.width_mm
                                  ? fmt::format("exemplar.width_mm = {:g}", *settings.exemplar.width_mm)
                                  : fmt::format("an exemplar of {:g} mm", natural);
    if (width > r.longest_side_mm)
        throw ConstraintsNotMet(fmt::format(
            "{} at synthesis.scale = {:g} is larger than the model's {:g} mm; use a scale of at most {:.3g}", named,
            scale, r.longest_side_mm, scale * r.longest_side_mm / width));
    constexpr double least_voxels = 8.0;
    if (width < least_voxels * r.voxel_mm)
        throw ConstraintsNotMet(
            fmt::format("{} at synthesis.scale = {:g} is under {:g} voxels of {:g} mm; use a width of {:.4g} mm or "
                        "shell.resolution = {}",
                        named, scale, least_voxels, r.voxel_mm, least_voxels * r.voxel_mm / scale,
                        resolution_for(r.longest_side_mm, width / least_voxels)));
    return width;
}

SynthesisSettings synthesis_settings(const SynthesisOptions& options, double pixels_per_voxel) {
    SynthesisSettings s = options.search;
    s.pixels_per_voxel = pixels_per_voxel;
    s.orientation = options.orientation.mode;
    s.direction = options.orientation.direction;
    return s;
}

// A bridge is as wide as a stroke of the pattern, so that it can pass for one.
ReinforceSettings reinforce_settings(const Settings& settings, const ResolvedSettings& r, double half_stroke_mm) {
    const StructureOptions& o = settings.structure;
    ReinforceSettings s = o.steps;
    s.thickness_mm = r.solidify.thickness_mm;
    s.inner_wall_mm = inner_wall_mm(s.rules, r.solidify);
    const double radius_mm = o.pattern_radius_mm.value_or(std::max(half_stroke_mm, 0.5 * r.enlarge.min_feature_mm));
    s.pattern_radius_voxels = radius_mm / r.voxel_mm;
    if (o.pattern_radius_mm && s.pattern_radius_voxels < kLeastRadiusVoxels * kSlack)
        throw ConstraintsNotMet(fmt::format(
            "structure.pattern_radius_mm = {:g} is under 1.5 voxels of {:g} mm; use {:.4g} or shell.resolution = {}",
            radius_mm, r.voxel_mm, kLeastRadiusVoxels * r.voxel_mm,
            resolution_for(r.longest_side_mm, radius_mm / kLeastRadiusVoxels)));
    s.pattern_radius_voxels = std::max(s.pattern_radius_voxels, kLeastRadiusVoxels);
    s.seed = settings.synthesis.search.seed;
    return s;
}

}  // namespace

double longest_side(const TriangleMesh& mesh) {
    if (mesh.positions_mm.empty()) throw InvalidInput("the model has no vertices");
    Vec3 low = mesh.positions_mm.front(), high = low;
    for (std::size_t v = 0; v < mesh.positions_mm.size(); ++v) {
        const Vec3& p = mesh.positions_mm[v];
        if (!p.allFinite()) throw InvalidInput(fmt::format("vertex {} has a coordinate that is not finite", v));
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    return (high - low).maxCoeff();
}

double input_scale(const TriangleMesh& mesh, const InputOptions& input) {
    const double side = longest_side(mesh);
    if (side <= 0 || !std::isfinite(side)) throw InvalidInput("the model has no extent");
    if (input.size_mm && input.scale != 1.0)
        throw ConstraintsNotMet(
            fmt::format("input.scale = {:g} and input.size_mm = {:g} name the same thing; leave one out (the size asks "
                        "for a scale of {:g})",
                        input.scale, *input.size_mm, *input.size_mm / side));
    const double scale = input.size_mm ? *input.size_mm / side : input.scale;
    if (scale * side < kLeastSideMm * kSlack || scale * side > kMostSideMm / kSlack)
        throw ConstraintsNotMet(fmt::format(
            "the model's longest side is {:g} mm, and Fretwork carves {:g} to {:g} mm; if the file is not in "
            "millimetres, set its size with --size-mm (input.size_mm), for instance --size-mm 100",
            scale * side, kLeastSideMm, kMostSideMm));
    return scale;
}

ExemplarFacts exemplar_facts(const Exemplar& exemplar, std::optional<double> natural_width_mm) {
    // Of a stroke of half width h, one pixel in h borders on empty, and the other way round for openings.
    std::array<std::size_t, 2> count = {0, 0}, border = {0, 0};
    for (std::size_t p = 0; p < exemplar.solid.size(); ++p) {
        const std::size_t kind = exemplar.solid[p] ? 1 : 0;
        ++count[kind];
        if (std::abs(exemplar.feature_distance_px[p]) < 1.0F) ++border[kind];
    }
    const auto half = [&](std::size_t kind) {
        return std::max(0.5,
                        static_cast<double>(count[kind]) / static_cast<double>(std::max<std::size_t>(border[kind], 1)));
    };
    return {exemplar.width, half(1), natural_width_mm, half(0)};
}

Material material_of(const StructureOptions& o) {
    Material material = material_by_name(o.material);
    if (o.youngs_modulus_mpa) material.youngs_modulus_mpa = *o.youngs_modulus_mpa;
    if (o.poissons_ratio) material.poissons_ratio = *o.poissons_ratio;
    if (o.density_kg_m3) material.density_kg_m3 = *o.density_kg_m3;
    if (o.strength_mpa) {
        material.strength_z_mpa = *o.strength_mpa;
        material.strength_xy_mpa = std::max(material.strength_xy_mpa, *o.strength_mpa);
    }
    return material;
}

ResolvedSettings resolve_settings(const Settings& settings, const SurfaceFacts& surface,
                                  const ExemplarFacts& exemplar) {
    ResolvedSettings r;
    r.longest_side_mm = surface.longest_side_mm;
    r.voxelize.resolution = choose_resolution(settings.shell, r.longest_side_mm);
    r.voxel_mm = r.longest_side_mm / r.voxelize.resolution;
    r.pyramid_levels =
        settings.synthesis.levels.value_or(std::bit_width(static_cast<unsigned>(r.voxelize.resolution - 1)));

    r.solidify.thickness_mm = wall_thickness(settings, r);
    r.solidify.side = settings.shell.side.value_or(surface.open ? WallSide::kCentred : WallSide::kInward);
    r.solidify.simplify_tolerance_voxels = settings.fabrication.simplify_voxels;
    r.solidify.keep_colors = settings.output.colour == OutputColor::kExemplar;
    r.solidify.target_triangles = static_cast<std::size_t>(settings.fabrication.target_triangles);

    const FabricationOptions& fabrication = settings.fabrication;
    r.enlarge.min_feature_mm =
        printable_width(fabrication.min_feature_mm, "fabrication.min_feature_mm", kLeastFeatureVoxels, fabrication, r);
    r.enlarge.min_hole_mm =
        printable_width(fabrication.min_hole_mm, "fabrication.min_hole_mm", kLeastHoleVoxels, fabrication, r);

    r.exemplar_width_mm = exemplar_width(settings, r, exemplar);
    const double pixels_per_voxel = exemplar.width_px * r.voxel_mm / r.exemplar_width_mm;
    if (pixels_per_voxel > 3.0)
        r.warnings.push_back(
            fmt::format("a voxel covers {:.1f} pixels of the exemplar, so its fine lines are lost; shell.resolution = "
                        "{} shows them",
                        pixels_per_voxel, static_cast<int>(std::ceil(r.voxelize.resolution * pixels_per_voxel / 1.5))));
    r.synthesis = synthesis_settings(settings.synthesis, pixels_per_voxel);

    r.material = material_of(settings.structure);
    r.reinforce = reinforce_settings(settings, r, exemplar.half_stroke_px / pixels_per_voxel * r.voxel_mm);
    if (const int halvings = choose_halvings(settings, surface, r); halvings > 0) coarsen(halvings, r);
    return r;
}

}  // namespace fretwork
