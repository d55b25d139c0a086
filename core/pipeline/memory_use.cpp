#include "core/pipeline/memory_use.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>

#include "core/base/error.h"

namespace fretwork {
namespace {

// The surfacing is the peak of most runs: labels, graphs, and the lattice, which grows a little with the wall.
constexpr double kBytesPerVoxel = 4700.0;
constexpr double kBytesPerVoxelOfWall = 100.0;
constexpr double kGrowth = 0.95;  // fitted power of the voxels, and where it makes no difference
constexpr double kGrowthPivot = 126000.0;
// On small shells it is the loop: equations of the samples, in memory that the threads keep.
constexpr double kLoopBytesPerSample = 160e3;
constexpr double kLoopBytesPerVoxel = 1500.0;
constexpr double kBytesPerTriangle = 700.0;  // input mesh, its box trees and its repair
constexpr double kBytesFixed = 90e6;
constexpr double kVoxelsPerArea = 1.6;  // a plane at any tilt meets 1 to 1.7 cells per cell face

double area_mm2(const TriangleMesh& mesh) {
    double area = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.positions_mm[t[0]];
        area += 0.5 * (mesh.positions_mm[t[1]] - a).cross(mesh.positions_mm[t[2]] - a).norm();
    }
    return area;
}

double bytes_at(double area, double triangles, double voxel_mm, const ResolvedSettings& settings) {
    const double voxels = kVoxelsPerArea * area / (voxel_mm * voxel_mm);
    const double per_voxel = kBytesPerVoxel + kBytesPerVoxelOfWall * settings.solidify.thickness_mm / voxel_mm;
    const double surfacing = per_voxel * voxels * std::pow(voxels / kGrowthPivot, kGrowth - 1.0);
    const double loop = kLoopBytesPerSample * settings.reinforce.samples + kLoopBytesPerVoxel * voxels;
    return kBytesFixed + kBytesPerTriangle * triangles + std::max(surfacing, loop);
}

}  // namespace

std::uint64_t estimated_peak_bytes(const TriangleMesh& mesh, const ResolvedSettings& settings) {
    return static_cast<std::uint64_t>(
        bytes_at(area_mm2(mesh), static_cast<double>(mesh.triangles.size()), settings.voxel_mm, settings));
}

std::uint64_t peak_memory_bytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (!line.starts_with("VmHWM:")) continue;
        const auto digits = line.find_first_of("0123456789");
        std::uint64_t kilobytes = 0;
        if (digits != std::string::npos) std::from_chars(line.data() + digits, line.data() + line.size(), kilobytes);
        return kilobytes * 1024;
    }
    return 0;
}

void check_memory(const TriangleMesh& mesh, const ResolvedSettings& settings, std::uint64_t max_bytes) {
    const std::uint64_t estimate = estimated_peak_bytes(mesh, settings);
    if (max_bytes == 0 || estimate <= max_bytes) return;
    const double area = area_mm2(mesh);
    int fitting = settings.voxelize.resolution;
    while (fitting > 8 && bytes_at(area, static_cast<double>(mesh.triangles.size()), settings.longest_side_mm / fitting,
                                   settings) > static_cast<double>(max_bytes))
        fitting = fitting * 7 / 8;
    throw MemoryLimit(fmt::format(
        "shell.resolution = {} needs about {:.0f} MB, and --max-memory allows {:.0f} MB; use shell.resolution = {}",
        settings.voxelize.resolution, static_cast<double>(estimate) / 1e6, static_cast<double>(max_bytes) / 1e6,
        fitting));
}

}  // namespace fretwork
