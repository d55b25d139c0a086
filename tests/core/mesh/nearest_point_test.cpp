#include "core/mesh/nearest_point.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/base/counter_random.h"

namespace fretwork {
namespace {

TEST_CASE("nearest point: as found one by one, the lowest of those that are as near", "[mesh]") {
    // Points of a small lattice, most of them several times.
    const auto coordinate = [](std::uint64_t i, int axis) {
        return std::floor(
            5.0 * unit_interval(counter_random(3, RandomStream::kTest, static_cast<std::uint32_t>(axis), i, 0)));
    };
    std::vector<Vec3> points;
    for (std::uint64_t i = 0; i < 400; ++i) points.emplace_back(coordinate(i, 0), coordinate(i, 1), coordinate(i, 2));
    const NearestPoint nearest(points);
    for (std::uint64_t q = 0; q < 500; ++q) {
        const Vec3 at = 0.5 * Vec3(coordinate(1000 + q, 0), coordinate(1000 + q, 1), coordinate(1000 + q, 2));
        std::uint32_t lowest = 0;
        for (std::uint32_t i = 1; i < points.size(); ++i)
            if ((points[i] - at).norm() < (points[lowest] - at).norm()) lowest = i;
        CHECK(nearest.to(at) == lowest);
    }
}

}  // namespace
}  // namespace fretwork
