#include "core/enlarge/opening.h"

namespace fretwork {

VoxelMask opened(const GeodesicLinks& links, const VoxelMask& outside, const std::vector<float>& distance_to_outside,
                 double width_voxels, const RunControl& run, const Nearby& near, double reach_voxels) {
    const auto radius = static_cast<float>(0.5 * width_voxels);
    VoxelMask core(outside.size(), 0);
    for (std::size_t v = 0; v < core.size(); ++v)
        core[v] = outside[v] == 0 && distance_to_outside[v] >= radius - kWidthSlack && near.holds(v, reach_voxels);
    const std::vector<float> to_core = geodesic_distance(links, core, radius, run);
    VoxelMask covered(outside.size(), 0);
    for (std::size_t v = 0; v < core.size(); ++v)
        covered[v] = outside[v] == 0 && to_core[v] < radius - kWidthSlack ? 1 : 0;
    return covered;
}

}  // namespace fretwork
