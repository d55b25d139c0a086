// Distances along the surface between surface voxels.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/base/bulk_vector.h"
#include "core/base/run_control.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Links between surface voxels up to two steps of G_surface apart, in compressed rows. A link's length is the
/// straight distance between the two surface points, stretched to the arc that their normals span, in voxels.
///
/// Paths over these links are at most 2.7 % longer than the geodesic on a flat sheet (16 directions), where paths
/// over the 26 neighbours alone are up to 8 % longer and count cells instead of millimetres on slanted sheets.
struct GeodesicLinks {
    std::vector<std::uint32_t> first;
    BulkVector<VoxelIndex> neighbor;
    BulkVector<float> length_voxels;

    [[nodiscard]] std::size_t size() const { return first.empty() ? 0 : first.size() - 1; }
};

/// Cost: linear in the links, about forty per voxel; parallel.
GeodesicLinks link_two_rings(const SurfaceVoxels& shell, const RunControl& run = {});

/// One byte per voxel, not zero where it belongs to the set.
using VoxelMask = std::vector<std::uint8_t>;

constexpr float kBeyondReach = std::numeric_limits<float>::infinity();

/// Distance in voxels from each voxel to the nearest of `sources`; kBeyondReach where it exceeds `reach_voxels`.
/// Cost: linear in the links of the voxels within reach; parallel.
std::vector<float> geodesic_distance(const GeodesicLinks& links, const VoxelMask& sources, double reach_voxels,
                                     const RunControl& run = {});

/// Calls visit(voxel, distance) for the voxels within `reach_voxels` of one, nearest first, ties by index.
/// Keeps its working memory between calls, so that many small discs cost only what they touch.
class GeodesicDisc {
  public:
    explicit GeodesicDisc(const GeodesicLinks& links);

    template <class Visit>
    void visit(VoxelIndex center, double reach_voxels, const Visit& visit_voxel) {
        collect(center, reach_voxels);
        for (const Reached& r : reached_) visit_voxel(r.voxel, r.distance);
    }

  private:
    struct Reached {
        VoxelIndex voxel;
        float distance;
    };
    void collect(VoxelIndex center, double reach_voxels);

    const GeodesicLinks* links_;
    std::vector<float> distance_;
    std::vector<Reached> reached_;
    std::vector<VoxelIndex> touched_;
    std::vector<std::pair<float, VoxelIndex>> heap_;
};

}  // namespace fretwork
