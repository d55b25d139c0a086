#include "cli/vase.h"

#include <cmath>
#include <numbers>

namespace fretwork::cli {
namespace {

constexpr int kRings = 48;
constexpr int kSegments = 96;
constexpr double kHeightMm = 100.0;

// Belly, neck and lip: a cosine on top of a slow taper.
double radius_mm(double share) {
    return 27.0 - 4.0 * share + 9.0 * std::sin(2.2 * std::numbers::pi * share + 0.15);
}

}  // namespace

TriangleMesh make_vase() {
    TriangleMesh vase;
    for (int ring = 0; ring <= kRings; ++ring) {
        const double share = static_cast<double>(ring) / kRings;
        for (int segment = 0; segment < kSegments; ++segment) {
            const double angle = 2.0 * std::numbers::pi * segment / kSegments;
            const double r = radius_mm(share);
            vase.positions_mm.emplace_back(r * std::cos(angle), r * std::sin(angle), kHeightMm * share);
        }
    }
    const auto bottom = static_cast<std::uint32_t>(vase.positions_mm.size());
    vase.positions_mm.emplace_back(0.0, 0.0, 0.0);
    for (std::uint32_t segment = 0; segment < kSegments; ++segment) {
        const std::uint32_t next = (segment + 1) % kSegments;
        for (std::uint32_t ring = 0; ring < kRings; ++ring) {
            const std::uint32_t low = ring * kSegments, high = low + kSegments;
            vase.triangles.push_back({low + segment, low + next, high + next});
            vase.triangles.push_back({low + segment, high + next, high + segment});
        }
        vase.triangles.push_back({bottom, next, segment});
    }
    return vase;
}

Region vase_lip() {
    return {"the lip", OpenBorderRegion{2.0}};
}

}  // namespace fretwork::cli
