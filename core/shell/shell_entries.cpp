#include "core/shell/shell_entries.h"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <span>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/parallel.h"
#include "core/shell/sheets.h"

namespace fretwork {
namespace {

struct Entry {
    VoxelCoord coord;
    Vec3f normal;
    Vec3 point;  // grid coordinates
    Vec3f centroid;
    std::uint32_t triangle;
    float area;
    float facing_area;
    std::uint32_t first_triangle;  // position in Layer::triangles
};

// All entries of one layer of cells.
struct Layer {
    std::vector<Entry> entries;
    std::vector<std::uint32_t> triangles;
};

// Mean normal of the patches, or of the larger of two sides that cancel. Zero where no triangle has an area.
Vec3 mean_normal(std::span<const Patch* const> patches, const GriddedMesh& mesh) {
    // Below this share of the area, what is left of the sum says nothing about a side.
    constexpr double kCancelled = 1e-3;
    Vec3 sum = Vec3::Zero();
    double area = 0.0;
    for (const Patch* patch : patches) {
        sum += static_cast<double>(patch->area) * mesh.normals[patch->triangle];
        area += static_cast<double>(patch->area);
    }
    if (sum.norm() > kCancelled * area) return sum.normalized();

    // Sides are told apart by the first normal there is. Where all areas are zero (the cell is touched at a point
    // or along an edge), every patch counts alike.
    Vec3 first = Vec3::Zero();
    Vec3 side[2] = {Vec3::Zero(), Vec3::Zero()};
    for (const Patch* patch : patches) {
        const Vec3& normal = mesh.normals[patch->triangle];
        if (first == Vec3::Zero()) first = normal;
        side[first.dot(normal) < 0.0] += (area > 0.0 ? static_cast<double>(patch->area) : 1.0) * normal;
    }
    // Two equal sides differ by the rounding of their areas; then the first one decides.
    const Vec3& larger = side[0].norm() >= (1.0 - 1e-5) * side[1].norm() ? side[0] : side[1];
    return larger.norm() > 0.0 ? larger.normalized() : first;
}

class LayerBuilder {
  public:
    LayerBuilder(const GriddedMesh& mesh, int z, int extent_x)
        : mesh_(mesh), splitter_(mesh), z_(z), extent_x_(static_cast<std::uint32_t>(extent_x)) {}

    /// Patches of one layer, triangles ascending.
    Layer build(std::span<const Patch> patches) {
        sort_into_cells(patches);
        layer_.triangles.reserve(patches.size());
        layer_.entries.reserve(patches.size() / 2);
        std::size_t begin = 0;
        while (begin < order_.size()) {
            std::size_t end = begin + 1;
            const std::uint32_t cell = patches[order_[begin]].row_x;
            while (end < order_.size() && patches[order_[end]].row_x == cell) ++end;
            in_cell_.clear();
            for (std::size_t i = begin; i < end; ++i) in_cell_.push_back(&patches[order_[i]]);
            add_cell();
            begin = end;
        }
        return std::move(layer_);
    }

  private:
    // Rows first by counting, then the few patches of a row by comparing; equal cells keep their order.
    void sort_into_cells(std::span<const Patch> patches) {
        std::vector<std::uint32_t> row_first(1, 0);
        for (const Patch& p : patches) {
            const std::size_t row = p.row_x / extent_x_;
            if (row + 1 >= row_first.size()) row_first.resize(row + 2, 0);
            ++row_first[row + 1];
        }
        std::partial_sum(row_first.begin(), row_first.end(), row_first.begin());
        std::vector<std::uint64_t> keys(patches.size());
        std::vector<std::uint32_t> next = row_first;
        for (std::uint32_t i = 0; i < patches.size(); ++i)
            keys[next[patches[i].row_x / extent_x_]++] = std::uint64_t{patches[i].row_x} << 32 | i;
        for (std::size_t row = 0; row + 1 < row_first.size(); ++row)
            std::sort(keys.begin() + row_first[row], keys.begin() + row_first[row + 1]);
        order_.resize(patches.size());
        for (std::size_t i = 0; i < keys.size(); ++i) order_[i] = static_cast<std::uint32_t>(keys[i]);
    }

    void add_cell() {
        const std::uint32_t row_x = in_cell_.front()->row_x;
        const VoxelCoord coord = {static_cast<int>(row_x % extent_x_), static_cast<int>(row_x / extent_x_), z_};
        const Vec3 center(coord[0] + 0.5, coord[1] + 0.5, coord[2] + 0.5);
        triangles_.clear();
        for (const Patch* patch : in_cell_) triangles_.push_back(patch->triangle);
        const std::vector<std::uint32_t>& sheet = splitter_.split(triangles_, center);
        if (splitter_.sheets() == 1) {
            add_sheet(in_cell_, coord, center);
            return;
        }
        sheet_first_.assign(splitter_.sheets() + 1, 0);
        for (const std::uint32_t s : sheet) ++sheet_first_[s + 1];
        std::partial_sum(sheet_first_.begin(), sheet_first_.end(), sheet_first_.begin());
        by_sheet_.resize(in_cell_.size());
        std::vector<std::uint32_t>& next = triangles_;  // not needed any more
        next.assign(sheet_first_.begin(), sheet_first_.end() - 1);
        for (std::size_t i = 0; i < in_cell_.size(); ++i) by_sheet_[next[sheet[i]]++] = in_cell_[i];
        for (std::size_t s = 0; s + 1 < sheet_first_.size(); ++s)
            add_sheet(std::span(by_sheet_).subspan(sheet_first_[s], sheet_first_[s + 1] - sheet_first_[s]), coord,
                      center);
    }

    void add_sheet(std::span<const Patch* const> patches, const VoxelCoord& coord, const Vec3& center) {
        Entry entry;
        entry.coord = coord;
        entry.first_triangle = static_cast<std::uint32_t>(layer_.triangles.size());
        double area = 0.0;
        Vec3 moment = Vec3::Zero();
        Vec3 facing = Vec3::Zero();
        const Patch* closest = patches.front();
        for (const Patch* patch : patches) {
            layer_.triangles.push_back(patch->triangle);
            area += static_cast<double>(patch->area);
            moment += static_cast<double>(patch->area) * patch->centroid.cast<double>();
            facing += static_cast<double>(patch->area) * mesh_.normals[patch->triangle];
            if (patch->closest.squaredNorm() < closest->closest.squaredNorm()) closest = patch;
        }
        entry.normal = mean_normal(patches, mesh_).cast<float>();
        entry.area = static_cast<float>(area);
        entry.facing_area = static_cast<float>(facing.norm());
        entry.triangle = closest->triangle;
        // The patch holds the point in single precision; put it back into the plane of its triangle.
        entry.point = center + closest->closest.cast<double>();
        const Vec3& normal = mesh_.normals[closest->triangle];
        entry.point -= normal * normal.dot(entry.point - mesh_.points[mesh_.triangles[closest->triangle][0]]);
        entry.centroid = area > 0.0 ? Vec3f((center + moment / area).cast<float>()) : Vec3f(entry.point.cast<float>());
        layer_.entries.push_back(entry);
    }

    const GriddedMesh& mesh_;
    SheetSplitter splitter_;
    int z_;
    std::uint32_t extent_x_;
    Layer layer_;
    std::vector<std::uint32_t> order_;
    std::vector<const Patch*> in_cell_;
    std::vector<std::uint32_t> triangles_;
    std::vector<std::uint32_t> sheet_first_;
    std::vector<const Patch*> by_sheet_;
};

// One array per task: what costs is the first touch of their memory.
void resize(SurfaceVoxels& shell, EntryTriangles& triangles, std::size_t count, std::size_t triangle_count) {
    const std::array<std::function<void()>, 8> arrays = {
        [&] { shell.coords.resize(count); },           [&] { shell.normals.resize(count); },
        [&] { shell.points_mm.resize(count); },        [&] { shell.triangles.resize(count); },
        [&] { shell.area_mm2.resize(count); },         [&] { shell.facing_area_mm2.resize(count); },
        [&] { shell.centroids_voxels.resize(count); }, [&] { triangles.triangle.resize(triangle_count); }};
    parallel_for(arrays.size(), 1, [&](std::size_t k) { arrays[k](); });
    triangles.first.resize(count + 1);
    triangles.first.back() = static_cast<std::uint32_t>(triangle_count);
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
        shell.facing_area_mm2[v] = static_cast<float>(voxel * voxel * static_cast<double>(entry.facing_area));
        shell.centroids_voxels[v] = entry.centroid;
        triangles.first[v] = static_cast<std::uint32_t>(first_triangle + entry.first_triangle);
    }
    std::copy(layer.triangles.begin(), layer.triangles.end(),
              triangles.triangle.begin() + static_cast<std::ptrdiff_t>(first_triangle));
}

}  // namespace

EntryTriangles make_entries(const GriddedMesh& mesh, const LayeredPatches& patches, SurfaceVoxels& shell,
                            const RunControl& run) {
    const std::size_t layer_count = patches.first.size() - 1;
    std::vector<Layer> layers(layer_count);
    parallel_for(layer_count, 1, [&](std::size_t z) {
        run.throw_if_stopped();
        LayerBuilder builder(mesh, static_cast<int>(z), shell.grid.extent[0]);
        layers[z] = builder.build(
            std::span(patches.patches).subspan(patches.first[z], patches.first[z + 1] - patches.first[z]));
    });

    std::vector<std::size_t> first_entry(layer_count + 1, 0);
    for (std::size_t z = 0; z < layer_count; ++z) first_entry[z + 1] = first_entry[z] + layers[z].entries.size();
    EntryTriangles result;
    resize(shell, result, first_entry.back(), patches.patches.size());
    parallel_for(layer_count, 1, [&](std::size_t z) {
        copy_layer(layers[z], first_entry[z], patches.first[z], shell, result);
        layers[z] = {};
    });
    return result;
}

void fill_missing_normals(const TouchingEntries& touching, const TouchingLinks& links, std::vector<Vec3f>& normals) {
    std::vector<VoxelIndex> missing;
    for (VoxelIndex v = 0; v < normals.size(); ++v)
        if (normals[v] == Vec3f::Zero()) missing.push_back(v);
    while (!missing.empty()) {
        // All of one round look at the round before, so that the order does not matter.
        std::vector<Vec3f> found(missing.size(), Vec3f::Zero());
        for (std::size_t i = 0; i < missing.size(); ++i)
            touching.visit(missing[i], [&](VoxelIndex w, int code) {
                if (links.holds(touching.rows(), missing[i], w, code)) found[i] += normals[w];
            });
        std::vector<VoxelIndex> left;
        for (std::size_t i = 0; i < missing.size(); ++i)
            if (found[i].norm() > 1e-3F)
                normals[missing[i]] = found[i].normalized();
            else
                left.push_back(missing[i]);
        if (left.size() == missing.size()) {
            for (const VoxelIndex v : left) normals[v] = Vec3f::UnitZ();
            return;
        }
        missing = std::move(left);
    }
}

std::vector<std::uint32_t> components_by_lowest_triangle(const Adjacency& adjacency, const EntryTriangles& triangles) {
    const std::size_t count = adjacency.first.size() - 1;
    // Links to earlier entries lie close by in memory, which a flood does not.
    DisjointSets sets(count);
    for (VoxelIndex v = 0; v < count; ++v)
        for (const VoxelIndex w : adjacency.of(v)) {
            if (w > v) break;  // seen from there
            sets.unite(v, w);
        }
    constexpr std::uint32_t none = 0xffffffffu;
    std::vector<std::uint32_t> component(count);
    std::vector<std::uint32_t> lowest;  // triangle of each component
    for (VoxelIndex v = 0; v < count; ++v) {
        const std::uint32_t root = sets.find(v);  // an earlier entry, or v itself
        if (root == v) lowest.push_back(none);
        component[v] = root == v ? static_cast<std::uint32_t>(lowest.size() - 1) : component[root];
        lowest[component[v]] = std::min(lowest[component[v]], triangles.of(v).front());
    }
    std::vector<std::uint32_t> by_triangle(lowest.size());
    std::iota(by_triangle.begin(), by_triangle.end(), 0u);
    std::sort(by_triangle.begin(), by_triangle.end(),
              [&](std::uint32_t a, std::uint32_t b) { return lowest[a] < lowest[b]; });
    std::vector<std::uint32_t> number(lowest.size());
    for (std::uint32_t rank = 0; rank < number.size(); ++rank) number[by_triangle[rank]] = rank;
    for (std::uint32_t& c : component) c = number[c];
    return component;
}

}  // namespace fretwork
