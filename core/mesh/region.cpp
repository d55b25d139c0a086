#include "core/mesh/region.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/mesh/check_mesh.h"
#include "core/mesh/region_shapes.h"

namespace fretwork {

struct RegionField::Impl {
    std::vector<std::unique_ptr<regions::Shape>> inside_of, outside_of;
};

RegionField::RegionField(const TriangleMesh& mesh, const std::vector<Region>& regions,
                         const std::vector<Region>& outside_of)
    : impl_(std::make_unique<Impl>()) {
    check_mesh(mesh, "regions");
    for (const Region& region : regions) impl_->inside_of.push_back(regions::prepare(mesh, region));
    for (const Region& region : outside_of) impl_->outside_of.push_back(regions::prepare(mesh, region));
}

RegionField::~RegionField() = default;
RegionField::RegionField(RegionField&&) noexcept = default;
RegionField& RegionField::operator=(RegionField&&) noexcept = default;

bool RegionField::empty() const {
    return impl_->inside_of.empty() && impl_->outside_of.empty();
}

double RegionField::signed_distance_mm(const Vec3& point_mm, std::uint32_t triangle) const {
    constexpr double far = std::numeric_limits<double>::infinity();
    const auto union_of = [&](const std::vector<std::unique_ptr<regions::Shape>>& shapes) {
        double least = far;
        for (const auto& shape : shapes) least = std::min(least, shape->signed_distance_mm(point_mm, triangle));
        return least;
    };
    const double inside = union_of(impl_->inside_of);
    return impl_->outside_of.empty() ? inside : std::min(inside, -union_of(impl_->outside_of));
}

}  // namespace fretwork
