#include "core/strength/voxel_stress.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/nearest_rank.h"
#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr std::size_t kGrain = 4096;
constexpr double kPaPerMpa = 1e6;

}  // namespace

double von_mises(const Stress& s) {
    const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
    const double shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    return std::sqrt(0.5 * (a * a + b * b + c * c) + 3.0 * shear);
}

double safety_factor_of(const Stress& s, const Vec3& layers, const Material& material) {
    Eigen::Matrix3d tensor;
    tensor << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    const Vec3 normal = layers.normalized();
    const Vec3 traction = tensor * normal;
    const double across = traction.dot(normal);
    const double along = (traction - across * normal).norm();
    const double pulled = std::max(across, 0.0);
    const double between = std::sqrt(pulled * pulled + 3.0 * along * along) / material.strength_z_mpa;
    const double used = std::max(between, von_mises(s) / material.strength_xy_mpa);
    return used * kMostFactor > 1.0 ? 1.0 / used : kMostFactor;
}

StressStatistics statistics_of(std::vector<float> values) {
    StressStatistics result;
    const std::size_t n = values.size();
    result.average_pa =
        sum_in_fixed_order(n, kGrain, 0.0, [&](std::size_t i) { return double{values[i]}; }) / static_cast<double>(n);
    const auto at_rank = [&](double share) {
        const auto nth = values.begin() + static_cast<std::ptrdiff_t>(nearest_rank(n, share));
        std::nth_element(values.begin(), nth, values.end());
        return double{*nth};
    };
    result.median_pa = at_rank(0.5);
    result.p99_pa = at_rank(0.99);
    result.max_pa = at_rank(1.0);
    return result;
}

VoxelJudge::VoxelJudge(const VoxelModel& model, Eigen::Matrix<double, 6, 24> center_stress,
                       const StrengthSettings& settings)
    : model_(model), center_stress_(std::move(center_stress)), settings_(settings), worst_(model.voxels.size()) {}

void VoxelJudge::add_case(const NodeValues<double>& u, std::uint32_t number, StrengthCase& result) {
    std::vector<float> sums(model_.voxels.size()), largest(model_.voxels.size()), factors(model_.voxels.size());
    if (settings_.keep_fields) result.stress_mpa.resize(model_.voxels.size());
    parallel_for(model_.voxels.size(), kGrain, [&](std::size_t v) {
        Eigen::Matrix<double, 24, 1> corners;
        for (std::size_t c = 0; c < 8; ++c)
            for (std::size_t axis = 0; axis < 3; ++axis)
                corners[static_cast<int>(3 * c + axis)] = u[3 * std::size_t{model_.corners[v][c]} + axis];
        const Stress stress = center_stress_ * corners;
        if (settings_.keep_fields) result.stress_mpa[v] = stress;
        const double factor = safety_factor_of(stress, settings_.layers, settings_.material);
        sums[v] = static_cast<float>(kPaPerMpa * principal_stress_sum(stress));
        largest[v] = static_cast<float>(kPaPerMpa * von_mises(stress));
        factors[v] = static_cast<float>(factor);
        Worst& worst = worst_[v];
        worst.stress_sum_pa = std::max(worst.stress_sum_pa, sums[v]);
        if (factors[v] < worst.factor) {
            worst.factor = factors[v];
            worst.von_mises_pa = largest[v];
            worst.load_case = number;
        }
    });
    result.max_von_mises_pa = double{*std::ranges::max_element(largest)};
    result.least_factor = double{*std::ranges::min_element(factors)};
    result.stress_sum = statistics_of(std::move(sums));
    double most_squared = 0.0;
    for (std::size_t n = 0; n < model_.nodes.size(); ++n) {
        const Vec3 moved(u[3 * n], u[3 * n + 1], u[3 * n + 2]);
        most_squared = std::max(most_squared, moved.squaredNorm());
        if (settings_.keep_fields) result.displacement_mm.push_back(moved);
    }
    result.max_displacement_mm = std::sqrt(most_squared);
}

std::vector<WeakPlace> VoxelJudge::weakest_places() const {
    const VoxelCoord& extent = model_.grid.extent;
    const double apart_voxels = std::max(3.0, 0.04 * std::max({extent[0], extent[1], extent[2]}));
    std::vector<std::uint8_t> near_another(worst_.size(), 0);
    std::vector<WeakPlace> places;
    while (places.size() < kMostWeakPlaces) {
        std::size_t weakest = worst_.size();
        for (std::size_t v = 0; v < worst_.size(); ++v)
            if (near_another[v] == 0 && (weakest == worst_.size() || worst_[v].factor < worst_[weakest].factor))
                weakest = v;
        if (weakest == worst_.size() || worst_[weakest].factor >= static_cast<float>(kMostFactor)) break;
        const Worst& found = worst_[weakest];
        const Vec3 at_mm = model_.grid.center_mm(model_.voxels[weakest]);
        places.push_back(
            {at_mm, double{found.factor}, double{found.stress_sum_pa}, double{found.von_mises_pa}, found.load_case});
        parallel_for(worst_.size(), kGrain, [&](std::size_t v) {
            const double distance_mm = (model_.grid.center_mm(model_.voxels[v]) - at_mm).norm();
            if (distance_mm <= apart_voxels * model_.grid.voxel_mm) near_another[v] = 1;
        });
    }
    return places;
}

void VoxelJudge::conclude(StrengthReport& report) const {
    report.worst_stress_sum_pa.resize(worst_.size());
    report.worst_factor.resize(worst_.size());
    for (std::size_t v = 0; v < worst_.size(); ++v) {
        report.worst_stress_sum_pa[v] = worst_[v].stress_sum_pa;
        report.worst_factor[v] = worst_[v].factor;
        report.least_factor = std::min(report.least_factor, double{worst_[v].factor});
    }
    report.stress_sum = statistics_of(report.worst_stress_sum_pa);
    report.weakest = weakest_places();
}

}  // namespace fretwork
