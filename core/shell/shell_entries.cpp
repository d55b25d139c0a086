#include "core/shell/shell_entries.h"

#include <algorithm>
#include <numeric>

#include "core/base/parallel.h"
#include "core/shell/components.h"
#include "core/shell/sheets.h"

namespace fretwork {
namespace {

struct Entry {
    VoxelCoord coord;
    Vec3f normal;
    Vec3 point;  // grid coordinates
    std::uint32_t triangle;
    float area;
    std::uint32_t first_triangle;  // position in Layer::triangles
};

// All entries of one layer of cells.
struct Layer {
    std::vector<Entry> entries;
    std::vector<std::uint32_t> triangles;
};

// Mean normal of the patches, or of the larger of two sides that cancel.
Vec3 mean_normal(std::span<const Patch* const> patches, std::span<const Vec3> normal_of) {
    // Below this share of the area, what is left of the sum says nothing about a side.
    constexpr double kCancelled = 1e-3;
    Vec3 sum = Vec3::Zero();
    double area = 0.0;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        sum += static_cast<double>(patches[i]->area) * normal_of[i];
        area += static_cast<double>(patches[i]->area);
    }
    if (sum.norm() > kCancelled * area) return sum.normalized();

    // Sides are told apart by the first normal there is. Where all areas are zero (the cell is touched at a point
    // or along an edge), every patch counts alike.
    const auto first =
        std::find_if(normal_of.begin(), normal_of.end(), [](const Vec3& n) { return n != Vec3::Zero(); });
    if (first == normal_of.end()) return Vec3::Zero();
    Vec3 side[2] = {Vec3::Zero(), Vec3::Zero()};
    for (std::size_t i = 0; i < patches.size(); ++i)
        side[first->dot(normal_of[i]) < 0.0] +=
            (area > 0.0 ? static_cast<double>(patches[i]->area) : 1.0) * normal_of[i];
    // Two equal sides differ by the rounding of their areas; then the first one decides.
    return (side[0].norm() >= (1.0 - 1e-5) * side[1].norm() ? side[0] : side[1]).normalized();
}

class LayerBuilder {
  public:
    LayerBuilder(std::span<const Triangle> triangles, std::span<const Vec3> grid_points, int z, int extent_x)
        : triangles_(triangles),
          grid_points_(grid_points),
          splitter_(triangles, grid_points),
          z_(z),
          extent_x_(extent_x) {}

    /// Patches of one layer, triangles ascending.
    Layer build(std::span<const Patch> patches) {
        sort_into_cells(patches);
        std::size_t begin = 0;
        while (begin < order_.size()) {
            std::size_t end = begin + 1;
            const std::uint32_t cell = patches[order_[begin]].row_x;
            while (end < order_.size() && patches[order_[end]].row_x == cell) ++end;
            add_cell(patches, begin, end);
            begin = end;
        }
        return std::move(layer_);
    }

  private:
    // Rows first by counting, then the few patches of a row by comparing; equal cells keep their order.
    void sort_into_cells(std::span<const Patch> patches) {
        std::vector<std::uint32_t> row_first(1, 0);
        for (const Patch& p : patches) {
            const std::size_t row = p.row_x / static_cast<std::uint32_t>(extent_x_);
            if (row + 1 >= row_first.size()) row_first.resize(row + 2, 0);
            ++row_first[row + 1];
        }
        std::partial_sum(row_first.begin(), row_first.end(), row_first.begin());
        order_.resize(patches.size());
        std::vector<std::uint32_t> next = row_first;
        for (std::uint32_t i = 0; i < patches.size(); ++i)
            order_[next[patches[i].row_x / static_cast<std::uint32_t>(extent_x_)]++] = i;
        const auto by_cell = [&](std::uint32_t a, std::uint32_t b) {
            return patches[a].row_x != patches[b].row_x ? patches[a].row_x < patches[b].row_x : a < b;
        };
        for (std::size_t row = 0; row + 1 < row_first.size(); ++row)
            std::sort(order_.begin() + row_first[row], order_.begin() + row_first[row + 1], by_cell);
    }

    void add_cell(std::span<const Patch> patches, std::size_t begin, std::size_t end) {
        const std::uint32_t row_x = patches[order_[begin]].row_x;
        const auto extent = static_cast<std::uint32_t>(extent_x_);
        const VoxelCoord coord = {static_cast<int>(row_x % extent), static_cast<int>(row_x / extent), z_};
        const Vec3 center(coord[0] + 0.5, coord[1] + 0.5, coord[2] + 0.5);
        in_cell_.clear();
        for (std::size_t i = begin; i < end; ++i) in_cell_.push_back(patches[order_[i]].triangle);
        const std::vector<std::uint32_t>& sheet = splitter_.split(in_cell_, center);
        for (std::uint32_t s = 0; s < splitter_.sheets(); ++s) {
            members_.clear();
            for (std::size_t i = begin; i < end; ++i)
                if (sheet[i - begin] == s) members_.push_back(&patches[order_[i]]);
            add_sheet(coord, center);
        }
    }

    void add_sheet(const VoxelCoord& coord, const Vec3& center) {
        Entry entry;
        entry.coord = coord;
        entry.first_triangle = static_cast<std::uint32_t>(layer_.triangles.size());
        normals_.clear();
        double area = 0.0;
        std::size_t closest = 0;
        for (std::size_t i = 0; i < members_.size(); ++i) {
            layer_.triangles.push_back(members_[i]->triangle);
            normals_.push_back(triangle_normal(corners(members_[i]->triangle)));
            area += static_cast<double>(members_[i]->area);
            if (members_[i]->closest.squaredNorm() < members_[closest]->closest.squaredNorm()) closest = i;
        }
        entry.normal = mean_normal(members_, normals_).cast<float>();
        entry.area = static_cast<float>(area);
        entry.triangle = members_[closest]->triangle;
        // The patch holds the point in single precision; put it back into the plane of its triangle.
        entry.point = center + members_[closest]->closest.cast<double>();
        const Vec3& normal = normals_[closest];
        entry.point -= normal * normal.dot(entry.point - grid_points_[triangles_[entry.triangle][0]]);
        layer_.entries.push_back(entry);
    }

    [[nodiscard]] Corners corners(std::uint32_t triangle) const {
        const Triangle& t = triangles_[triangle];
        return {grid_points_[t[0]], grid_points_[t[1]], grid_points_[t[2]]};
    }

    std::span<const Triangle> triangles_;
    std::span<const Vec3> grid_points_;
    SheetSplitter splitter_;
    int z_;
    int extent_x_;
    Layer layer_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> in_cell_;
    std::vector<const Patch*> members_;
    std::vector<Vec3> normals_;
};

void resize(SurfaceVoxels& shell, std::size_t count) {
    shell.coords.resize(count);
    shell.normals.resize(count);
    shell.points_mm.resize(count);
    shell.triangles.resize(count);
    shell.area_mm2.resize(count);
}

void copy_layer(const Layer& layer, std::size_t first_entry, std::size_t first_triangle, SurfaceVoxels& shell,
                EntryTriangles& triangles) {
    const double voxel = shell.grid.voxel_mm;
    for (std::size_t i = 0; i < layer.entries.size(); ++i) {
        const Entry& entry = layer.entries[i];
        const std::size_t v = first_entry + i;
        shell.coords[v] = entry.coord;
        shell.normals[v] = entry.normal;
        shell.points_mm[v] = shell.grid.origin_mm + voxel * entry.point;
        shell.triangles[v] = entry.triangle;
        shell.area_mm2[v] = static_cast<float>(voxel * voxel * static_cast<double>(entry.area));
        triangles.first[v] = static_cast<std::uint32_t>(first_triangle + entry.first_triangle);
    }
    std::copy(layer.triangles.begin(), layer.triangles.end(),
              triangles.triangle.begin() + static_cast<std::ptrdiff_t>(first_triangle));
}

}  // namespace

EntryTriangles make_entries(std::span<const Triangle> triangles, std::span<const Vec3> grid_points,
                            const LayeredPatches& patches, SurfaceVoxels& shell, const RunControl& run) {
    const std::size_t layer_count = patches.first.size() - 1;
    std::vector<Layer> layers(layer_count);
    parallel_for(layer_count, 1, [&](std::size_t z) {
        run.throw_if_stopped();
        LayerBuilder builder(triangles, grid_points, static_cast<int>(z), shell.grid.extent[0]);
        layers[z] = builder.build(
            std::span(patches.patches).subspan(patches.first[z], patches.first[z + 1] - patches.first[z]));
    });

    std::vector<std::size_t> first_entry(layer_count + 1, 0);
    for (std::size_t z = 0; z < layer_count; ++z) first_entry[z + 1] = first_entry[z] + layers[z].entries.size();
    resize(shell, first_entry.back());
    EntryTriangles result;
    result.first.resize(first_entry.back() + 1);
    result.first.back() = static_cast<std::uint32_t>(patches.patches.size());
    result.triangle.resize(patches.patches.size());
    parallel_for(layer_count, 1, [&](std::size_t z) {
        copy_layer(layers[z], first_entry[z], patches.first[z], shell, result);
        layers[z] = {};
    });
    return result;
}

std::vector<std::uint32_t> components_by_lowest_triangle(const Adjacency& adjacency, const EntryTriangles& triangles) {
    ShellComponents components = connected_components(adjacency);
    std::vector<std::uint32_t> lowest(components.count(), 0xffffffffu);
    for (VoxelIndex v = 0; v < components.of.size(); ++v)
        lowest[components.of[v]] = std::min(lowest[components.of[v]], triangles.of(v).front());
    std::vector<std::uint32_t> by_triangle(components.count());
    std::iota(by_triangle.begin(), by_triangle.end(), 0u);
    std::sort(by_triangle.begin(), by_triangle.end(),
              [&](std::uint32_t a, std::uint32_t b) { return lowest[a] < lowest[b]; });
    std::vector<std::uint32_t> number(components.count());
    for (std::uint32_t rank = 0; rank < number.size(); ++rank) number[by_triangle[rank]] = rank;
    for (std::uint32_t& c : components.of) c = number[c];
    return std::move(components.of);
}

}  // namespace fretwork
