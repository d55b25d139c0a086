#include "core/synthesis/plane_set.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace fretwork {
namespace {

constexpr int kCells = 32;  // per side of a cube face

std::vector<Vec3f> cube_directions() {
    std::vector<Vec3f> directions;
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x)
                if (x != 0 || y != 0 || z != 0) directions.push_back(Vec3(x, y, z).normalized().cast<float>());
    return directions;
}

/// Fibonacci lattice: equal steps in height, the golden angle between one and the next.
std::vector<Vec3f> spiral_directions(int count) {
    const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
    std::vector<Vec3f> directions;
    for (int i = 0; i < count; ++i) {
        const double z = 1.0 - (2.0 * i + 1.0) / count;
        const double r = std::sqrt(1.0 - z * z), angle = golden_angle * i;
        directions.push_back(Vec3(r * std::cos(angle), r * std::sin(angle), z).normalized().cast<float>());
    }
    return directions;
}

struct CubePosition {
    std::size_t face = 0;
    float a = 0.0F, b = 0.0F;  // in [-1, 1]
};

CubePosition on_cube(const Vec3f& d) {
    const Vec3f size = d.cwiseAbs();
    const int axis = size.x() >= size.y() ? (size.x() >= size.z() ? 0 : 2) : (size.y() >= size.z() ? 1 : 2);
    const float scale = 1.0F / size[axis];
    return {static_cast<std::size_t>(2 * axis + (d[axis] < 0.0F ? 1 : 0)), d[(axis + 1) % 3] * scale,
            d[(axis + 2) % 3] * scale};
}

Vec3f off_cube(const CubePosition& p) {
    const int axis = static_cast<int>(p.face) / 2;
    Vec3f d;
    d[axis] = p.face % 2 == 0 ? 1.0F : -1.0F;
    d[(axis + 1) % 3] = p.a;
    d[(axis + 2) % 3] = p.b;
    return d.normalized();
}

std::size_t cell_of(const Vec3f& d) {
    const CubePosition p = on_cube(d);
    constexpr int kHalf = kCells / 2;
    const auto index = [](float t) {
        return static_cast<std::size_t>(std::clamp(static_cast<int>((t + 1.0F) * kHalf), 0, kCells - 1));
    };
    return (p.face * kCells + index(p.a)) * kCells + index(p.b);
}

}  // namespace

PlaneSet::PlaneSet(int count, const Vec3f& up) : normals_(count == 26 ? cube_directions() : spiral_directions(count)) {
    for (const Vec3f& n : normals_) {
        Vec3f t = up - up.dot(n) * n;
        if (t.squaredNorm() < 1e-6F * up.squaredNorm()) {
            const Vec3f other = std::fabs(n.x()) < 0.6F ? Vec3f::UnitX() : Vec3f::UnitY();
            t = other - other.dot(n) * n;
        }
        up_.push_back(t.normalized());
        right_.push_back(up_.back().cross(n));
    }

    // A plane is nearest to some direction of a cell only if it is no farther from the cell's middle
    // than the nearest one, plus twice the way from the middle to a corner.
    cell_first_.push_back(0);
    for (std::size_t face = 0; face < 6; ++face)
        for (int i = 0; i < kCells; ++i)
            for (int j = 0; j < kCells; ++j) {
                const auto at = [&](double di, double dj) {
                    return off_cube({face, static_cast<float>((i + di) * 2.0 / kCells - 1.0),
                                     static_cast<float>((j + dj) * 2.0 / kCells - 1.0)});
                };
                const Vec3f middle = at(0.5, 0.5);
                double reach = 0.0;
                for (const double di : {0.0, 1.0})
                    for (const double dj : {0.0, 1.0})
                        reach = std::max(reach, std::acos(std::min(1.0, double(middle.dot(at(di, dj))))));
                double best = -1.0;
                for (const Vec3f& n : normals_) best = std::max(best, double(n.dot(middle)));
                const double angle = std::acos(std::min(1.0, best)) + 2.0 * reach + 1e-3;
                const double limit = std::cos(std::min(angle, std::numbers::pi));
                for (PlaneIndex p = 0; p < normals_.size(); ++p)
                    if (normals_[p].dot(middle) >= limit) cell_planes_.push_back(p);
                cell_first_.push_back(static_cast<std::uint32_t>(cell_planes_.size()));
            }
}

PlaneIndex PlaneSet::nearest(const Vec3f& direction) const {
    const std::size_t cell = cell_of(direction);
    PlaneIndex best = cell_planes_[cell_first_[cell]];
    float best_cosine = normals_[best].dot(direction);
    for (std::uint32_t i = cell_first_[cell] + 1; i < cell_first_[cell + 1]; ++i) {
        const float cosine = normals_[cell_planes_[i]].dot(direction);
        if (cosine > best_cosine) {
            best_cosine = cosine;
            best = cell_planes_[i];
        }
    }
    return best;
}

}  // namespace fretwork
