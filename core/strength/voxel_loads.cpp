#include "core/strength/voxel_loads.h"

#include <algorithm>
#include <limits>
#include <span>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/nearest_point.h"
#include "core/strength/cube_element.h"

namespace fretwork {
namespace {

std::vector<Vec3> centers_of(const VoxelModel& model) {
    std::vector<Vec3> centers;
    centers.reserve(model.voxels.size());
    for (const VoxelCoord& v : model.voxels) centers.push_back(model.grid.center_mm(v));
    return centers;
}

/// Holds the lowest part of pieces that nothing holds.
void hold_lowest(const VoxelModel& model, double share, std::vector<std::uint8_t>& held) {
    struct Piece {
        std::int32_t low = std::numeric_limits<std::int32_t>::max(), high = 0;
        bool is_held = false;
    };
    std::vector<Piece> pieces(model.pieces);
    for (std::size_t v = 0; v < model.voxels.size(); ++v) {
        Piece& piece = pieces[model.piece[v]];
        piece.low = std::min(piece.low, model.voxels[v][2]);
        piece.high = std::max(piece.high, model.voxels[v][2]);
        piece.is_held = piece.is_held || held[v] != 0;
    }
    for (std::size_t v = 0; v < model.voxels.size(); ++v) {
        const Piece& piece = pieces[model.piece[v]];
        // Centres of the piece's layers, measured from its lowest face; one layer always.
        const double at = model.voxels[v][2] - piece.low + 0.5, height = piece.high - piece.low + 1;
        if (!piece.is_held && (at <= share * height || model.voxels[v][2] == piece.low)) held[v] = 1;
    }
}

void push_patch(const SurfaceVoxels& shell, const PatchLoad& patch, const VoxelModel& model,
                const NearestPoint& nearest, BulkVector<double>& push_n) {
    const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, patch.voxels.size()));
    std::vector<std::uint32_t> takes(patch.voxels.size());
    parallel_for(takes.size(), 256, [&](std::size_t i) { takes[i] = nearest.to(shell.points_mm[patch.voxels[i]]); });
    for (std::size_t i = 0; i < takes.size(); ++i) {
        const VoxelIndex v = patch.voxels[i];
        const double pressed_n = patch.pressure_mpa * static_cast<double>(shell.area_mm2[v]);
        const Vec3 force_n = share * patch.force_n - pressed_n * shell.normals[v].cast<double>();
        // Trilinear shares, so that a force on the voxel keeps its line of action.
        const Vec3 at = ((shell.points_mm[v] - model.node_mm(model.corners[takes[i]][0])) / model.grid.voxel_mm)
                            .cwiseMax(0.0)
                            .cwiseMin(1.0);
        for (std::size_t c = 0; c < 8; ++c) {
            double part = 1.0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double high = at[static_cast<int>(axis)];
                part *= (kCornerBits[c] >> axis & 1) != 0 ? high : 1.0 - high;
            }
            for (std::size_t axis = 0; axis < 3; ++axis)
                push_n[3 * std::size_t{model.corners[takes[i]][c]} + axis] += part * force_n[static_cast<int>(axis)];
        }
    }
}

std::vector<std::uint8_t> held_voxels(const std::vector<VoxelIndex>& fixed, const std::vector<std::uint32_t>& nearest,
                                      std::size_t shell_size, const VoxelModel& model) {
    std::vector<std::uint8_t> is_fixed(shell_size, 0);
    for (const VoxelIndex v : fixed) is_fixed[v] = 1;
    std::vector<std::uint8_t> held(model.voxels.size());
    for (std::size_t v = 0; v < held.size(); ++v) held[v] = is_fixed[nearest[v]];
    hold_lowest(model, 0.1, held);
    return held;
}

}  // namespace

std::vector<VoxelCase> self_weight_cases(const VoxelModel& model, double fixed_share) {
    if (!(fixed_share > 0.0 && fixed_share <= 1.0))
        throw InvalidSetting("strength: fixed share " + std::to_string(fixed_share) + "; expected above 0, at most 1");
    std::vector<std::uint8_t> held(model.voxels.size(), 0);
    hold_lowest(model, fixed_share, held);
    return {{"self-weight along x", Vec3::UnitX(), {}, held},
            {"self-weight along y", Vec3::UnitY(), {}, held},
            {"self-weight along -z", -Vec3::UnitZ(), {}, held}};
}

std::vector<VoxelCase> cases_of(const ForceProfile& profile, const SurfaceVoxels& shell, const VoxelModel& model,
                                const RunControl& run) {
    const std::vector<Vec3> centers = centers_of(model);
    std::vector<std::uint32_t> nearest_entry(centers.size());
    {
        const NearestPoint entries(shell.points_mm, run);
        parallel_for(centers.size(), 1024, [&](std::size_t v) {
            if (v % 1024 == 0) run.throw_if_stopped();
            nearest_entry[v] = entries.to(centers[v]);
        });
    }
    const NearestPoint voxels(centers, run);
    std::vector<VoxelCase> cases;
    for (const LoadCase& load_case : profile.cases) {
        run.throw_if_stopped();
        VoxelCase& result = cases.emplace_back();
        result.name = load_case.name;
        result.acceleration_g = load_case.acceleration_g;
        result.held = held_voxels(load_case.fixed, nearest_entry, shell.size(), model);
        if (load_case.loads.empty()) continue;
        result.push_n.resize(3 * model.nodes.size());
        std::ranges::fill(result.push_n, 0.0);
        for (const PatchLoad& patch : load_case.loads) push_patch(shell, patch, model, voxels, result.push_n);
    }
    return cases;
}

}  // namespace fretwork
