#include "core/shell/cut_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace fretwork {
namespace {

// A share of the work: some whole triangles, or some layers of one triangle too large for a share.
struct Task {
    std::size_t triangle_begin;
    std::size_t triangle_end;
    int z_begin;
    int z_end;
};

constexpr double kCellsPerTask = 8192.0;

// A triangle passes through about as many cells as the largest face of its bounding box has.
double estimated_cells(const Corners& c) {
    const Vec3 size = c[0].cwiseMax(c[1]).cwiseMax(c[2]) - c[0].cwiseMin(c[1]).cwiseMin(c[2]) + Vec3::Ones();
    return size.prod() / size.minCoeff();
}

// Shares depend on the triangles alone, not on the threads, and follow the order of the triangles.
std::vector<Task> share_out(const GriddedMesh& mesh, int layers) {
    std::vector<Task> tasks;
    std::size_t begin = 0;
    double cells = 0.0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Corners corners = mesh.corners(static_cast<std::uint32_t>(t));
        const double more = estimated_cells(corners);
        if (cells + more > kCellsPerTask && begin < t) {
            tasks.push_back({begin, t, 0, layers});
            begin = t;
            cells = 0.0;
        }
        cells += more;
        if (cells <= kCellsPerTask) continue;
        const auto [low, high] = std::minmax({corners[0][2], corners[1][2], corners[2][2]});
        const int z_begin = std::max(0, static_cast<int>(std::floor(low)) - 1);
        const int z_end = std::min(layers, static_cast<int>(std::floor(high)) + 2);
        const int step = std::max(1, static_cast<int>((z_end - z_begin) * kCellsPerTask / cells));
        for (int z = z_begin; z < z_end; z += step) tasks.push_back({t, t + 1, z, std::min(z_end, z + step)});
        begin = t + 1;
        cells = 0.0;
    }
    if (begin < mesh.triangles.size()) tasks.push_back({begin, mesh.triangles.size(), 0, layers});
    return tasks;
}

// Where the patches of each task go: one position per task and layer, in this order within a layer.
class LayerOffsets {
  public:
    LayerOffsets(const std::vector<std::vector<Patch>>& of_task, std::size_t layers) : first_(layers + 1, 0) {
        ranges_.resize(of_task.size());
        parallel_for(of_task.size(), 1, [&](std::size_t k) {
            if (of_task[k].empty()) return;
            Range& range = ranges_[k];
            const auto by_z = [](const Patch& a, const Patch& b) { return a.z < b.z; };
            const auto [low, high] = std::minmax_element(of_task[k].begin(), of_task[k].end(), by_z);
            range.lowest = low->z;
            range.count.assign(high->z - low->z + 1, 0);
            for (const Patch& p : of_task[k]) ++range.count[p.z - range.lowest];
        });
        for (const Range& range : ranges_)
            for (std::size_t z = 0; z < range.count.size(); ++z) first_[range.lowest + z + 1] += range.count[z];
        for (std::size_t z = 0; z < layers; ++z) first_[z + 1] += first_[z];
        std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
        for (Range& range : ranges_)
            for (std::size_t z = 0; z < range.count.size(); ++z) {
                const std::size_t start = next[range.lowest + z];
                next[range.lowest + z] += range.count[z];
                range.count[z] = start;
            }
    }

    [[nodiscard]] const std::vector<std::size_t>& first() const { return first_; }

    void scatter(std::size_t task, const std::vector<Patch>& from, BulkVector<Patch>& to) {
        Range& range = ranges_[task];
        for (const Patch& p : from) to[range.count[p.z - range.lowest]++] = p;
    }

  private:
    struct Range {
        std::uint32_t lowest = 0;
        std::vector<std::size_t> count;  ///< patches per layer from `lowest` on; then the position of the next one
    };

    std::vector<std::size_t> first_;
    std::vector<Range> ranges_;
};

}  // namespace

LayeredPatches cut_mesh(const GriddedMesh& mesh, const VoxelCoord& extent, const RunControl& run) {
    const std::vector<Task> tasks = share_out(mesh, extent[2]);
    std::vector<std::vector<Patch>> of_task(tasks.size());
    parallel_for(tasks.size(), 1, [&](std::size_t k) {
        const Task& task = tasks[k];
        for (std::size_t t = task.triangle_begin; t < task.triangle_end; ++t)
            cut_triangle(mesh, static_cast<std::uint32_t>(t), extent, task.z_begin, task.z_end, of_task[k], run);
    });

    LayerOffsets offsets(of_task, static_cast<std::size_t>(extent[2]));
    LayeredPatches sorted;
    sorted.first = offsets.first();
    if (sorted.first.back() > std::numeric_limits<std::uint32_t>::max())
        throw MemoryLimit("voxelize: the surface falls into " + std::to_string(sorted.first.back()) +
                          " patches, expected fewer than 2^32; use a lower resolution or a simpler mesh");
    sorted.patches.resize(sorted.first.back());
    parallel_for(tasks.size(), 1, [&](std::size_t k) {
        run.throw_if_stopped();
        offsets.scatter(k, of_task[k], sorted.patches);
        of_task[k] = {};
    });
    return sorted;
}

}  // namespace fretwork
