#include "core/solidify/pattern_field.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/enlarge/geodesic_links.h"
#include "core/solidify/shell_index.h"
#include "core/solidify/smooth_border.h"
#include "core/solidify/texel_sampler.h"

namespace fretwork {
namespace {

constexpr std::size_t kGrain = 1024;

/// Radius of the kernel that blends the voxels' own views of the pattern, in voxels.
constexpr double kKernel = 1.6;
/// The same for colours, which bear less blur.
constexpr double kColorKernel = 1.5;
/// Between voxels whose colours differ by no more in any channel there is nothing to blend.
constexpr int kPlainStep = 4;

/// How far a label may move the border from where the states put it, in voxels.
constexpr double kLabelSlack = 0.75;

/// Two neighbouring labels tell the same story if one predicts the other's distance to within this, in voxels.
constexpr double kAgreement = 0.4;

/// A voxel this far from the border, by the kernel and the slack, speaks for all points nearest to it, in voxels.
constexpr float kFarFromBorder = 3.0F;
static_assert(kFarFromBorder > kKernel + kLabelSlack + 0.5 && kFarFromBorder < kBorderReach);

Rgb8 to_bytes(const Vec3& color) {
    Rgb8 bytes{};
    for (Eigen::Index k = 0; k < 3; ++k)
        bytes[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(std::lround(std::clamp(color[k], 0.0, 255.0)));
    return bytes;
}

std::vector<Vec3f> unit_normals(const TriangleMesh& mesh) {
    std::vector<Vec3f> normals(mesh.triangles.size(), Vec3f::Zero());
    for (std::size_t t = 0; t < normals.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const Vec3& p = mesh.positions_mm[a];
        const Vec3 n = (mesh.positions_mm[b] - p).cross(mesh.positions_mm[c] - p);
        const double length = n.norm();
        if (length > 0.0) normals[t] = (n / length).cast<float>();
    }
    return normals;
}

class VoxelPattern {
  public:
    VoxelPattern(const TriangleMesh& mesh, const SurfaceVoxels& shell, const GeodesicLinks& links,
                 const SolidStates& solid, const TexelFrames& frames, const Exemplar& exemplar, const RegionField& keep,
                 const RunControl& run)
        : shell_(shell),
          frames_(frames),
          keep_(keep),
          index_(shell),
          sampler_(exemplar),
          links_(links),
          normals_(unit_normals(mesh)) {
        wrap_frames(exemplar);
        build_border(solid, run);
        find_plain();
    }

    [[nodiscard]] double signed_distance_voxels(const Vec3& p, std::uint32_t triangle) const {
        double f = blended(p, triangle);
        if (!keep_.empty()) f = std::min(f, keep_.signed_distance_mm(p, triangle) / shell_.grid.voxel_mm);
        return f;
    }

    /// Blended as the distance is, over fewer voxels: a colour that jumped from voxel to voxel would have stairs for
    /// borders.
    [[nodiscard]] Rgb8 color(const Vec3& p, std::uint32_t triangle) const {
        const Vec3f& normal = normals_[triangle];
        const VoxelIndex base = index_.nearest(p, normal);
        if (base == ShellIndex::kNone) return {};
        if (plain_[base] != 0) return own_color_[base];
        Vec3 sum = Vec3::Zero();
        double weights = 0.0;
        const auto add = [&](VoxelIndex v) {
            const double w = weight(v, p, normal, kColorKernel);
            if (w <= 0.0) return;
            const auto [x, y] = texel(v, p);
            sum += w * sampler_.solid_color(x, y);
            weights += w;
        };
        add(base);
        for (const VoxelIndex v : shell_.adjacency.of(base)) add(v);
        if (!(weights > 0.0)) {
            const auto [x, y] = texel(base, p);
            return to_bytes(sampler_.solid_color(x, y));
        }
        return to_bytes(sum / weights);
    }

  private:
    void wrap_frames(const Exemplar& exemplar) {
        pixels_per_voxel_.resize(frames_.size());
        origin_.resize(frames_.size());
        const double width = exemplar.width, height = exemplar.height;
        for (std::size_t v = 0; v < frames_.size(); ++v) {
            const double u = static_cast<double>(frames_[v].u), w = static_cast<double>(frames_[v].v);
            origin_[v] = Vec2(u - width * std::floor(u / width), w - height * std::floor(w / height));
            const double scale = std::sqrt(static_cast<double>(frames_[v].du.norm() * frames_[v].dv.norm()));
            pixels_per_voxel_[v] = static_cast<float>(scale > 1e-6 ? scale : 1.0);
        }
    }

    /// Voxels with neighbours of their own colour all around.
    void find_plain() {
        own_color_.resize(shell_.size());
        parallel_for(shell_.size(), kGrain, [&](std::size_t i) {
            const auto [u, w] = texel(static_cast<VoxelIndex>(i), shell_.points_mm[i]);
            own_color_[i] = to_bytes(sampler_.solid_color(u, w));
        });
        plain_.resize(shell_.size());
        parallel_for(shell_.size(), kGrain, [&](std::size_t i) {
            bool plain = true;
            for (const VoxelIndex v : shell_.adjacency.of(static_cast<VoxelIndex>(i)))
                for (std::size_t k = 0; k < 3; ++k)
                    plain = plain && std::abs(int{own_color_[i][k]} - int{own_color_[v][k]}) <= kPlainStep;
            plain_[i] = plain ? 1 : 0;
        });
    }

    [[nodiscard]] std::pair<double, double> texel(VoxelIndex v, const Vec3& p) const {
        const Vec3f d = ((p - shell_.points_mm[v]) / shell_.grid.voxel_mm).cast<float>();
        return {origin_[v].x() + static_cast<double>(frames_[v].du.dot(d)),
                origin_[v].y() + static_cast<double>(frames_[v].dv.dot(d))};
    }

    /// The pattern's distance at p as the label of v sees it, in voxels.
    [[nodiscard]] double label_distance(VoxelIndex v, const Vec3& p) const {
        const auto [u, w] = texel(v, p);
        return sampler_.feature_distance(u, w) / static_cast<double>(pixels_per_voxel_[v]);
    }

    void build_border(const SolidStates& solid, const RunControl& run) {
        const std::size_t n = shell_.size();
        std::vector<float> label(n);
        parallel_for(n, kGrain, [&](std::size_t v) {
            label[v] = static_cast<float>(label_distance(static_cast<VoxelIndex>(v), shell_.points_mm[v]));
        });
        const VoxelMask states = carved_states(solid, label);
        const std::vector<float> from_states = signed_border_distance(links_, states, run);
        trusted_ = trusted_labels(label, states);
        value_ = from_states;
        for (std::size_t v = 0; v < n; ++v)
            if (trusted_[v] != 0)
                value_[v] = std::clamp(label[v], from_states[v] - static_cast<float>(kLabelSlack),
                                       from_states[v] + static_cast<float>(kLabelSlack));
        smooth_along_levels(shell_, links_, from_states, trusted_, value_, run);
        gradient_ = surface_gradient(shell_, links_, value_);
    }

    /// States with the kept regions taken out where the pattern itself is empty: those regions come back with their
    /// own exact border, which the voxels' would only roughen.
    [[nodiscard]] VoxelMask carved_states(const SolidStates& solid, const std::vector<float>& label) const {
        VoxelMask states(shell_.size());
        parallel_for(shell_.size(), kGrain, [&](std::size_t v) {
            states[v] = solid[v] == SolidState::kSolid ? 1 : 0;
            if (states[v] != 0 && label[v] > 0.0F && !keep_.empty() &&
                keep_.signed_distance_mm(shell_.points_mm[v], shell_.triangles[v]) <= 0.0)
                states[v] = 0;
        });
        return states;
    }

    /// A label may draw the border if it agrees with the states all around and with the labels next to it.
    [[nodiscard]] VoxelMask trusted_labels(const std::vector<float>& label, const VoxelMask& states) const {
        const auto agrees = [&](VoxelIndex v) {
            return (label[v] < 0.0F) == (states[v] != 0) || std::abs(label[v]) < 0.2F;
        };
        VoxelMask trusted(shell_.size());
        parallel_for(shell_.size(), kGrain, [&](std::size_t i) {
            const auto v = static_cast<VoxelIndex>(i);
            bool good = agrees(v);
            for (const VoxelIndex u : shell_.adjacency.of(v)) {
                if (!good) break;
                good = agrees(u) && (std::abs(label[u]) > 3.0F || std::abs(label_distance(v, shell_.points_mm[u]) -
                                                                           static_cast<double>(label[u])) < kAgreement);
            }
            trusted[v] = good ? 1 : 0;
        });
        return trusted;
    }

    /// The pattern at p as voxel v sees it: its label's feature distance where that is trusted, within reach of the
    /// plane through its own value.
    [[nodiscard]] double seen_from(VoxelIndex v, const Vec3& p) const {
        const Vec3f d = ((p - shell_.points_mm[v]) / shell_.grid.voxel_mm).cast<float>();
        const double plane = static_cast<double>(value_[v] + gradient_[v].dot(d));
        if (trusted_[v] == 0) return plane;
        return std::clamp(label_distance(v, p), plane - kLabelSlack, plane + kLabelSlack);
    }

    /// Share of a voxel in what is blended at p. It falls to zero with zero slope at the kernel's rim, so that there is
    /// no step where a voxel comes into reach.
    [[nodiscard]] double weight(VoxelIndex v, const Vec3& p, const Vec3f& normal, double kernel) const {
        const double radius = kernel * shell_.grid.voxel_mm;
        const double r2 = (p - shell_.points_mm[v]).squaredNorm() / (radius * radius);
        if (r2 >= 1.0) return 0.0;
        // Round a rim of a thin plate the other side is two steps away and does not belong to this one.
        const double facing = static_cast<double>(normal.dot(shell_.normals[v])) + 0.3;
        return facing <= 0.0 ? 0.0 : (1.0 - r2) * (1.0 - r2) * std::min(facing, 0.5);
    }

    /// Blend over the voxels of the sheet within the kernel.
    [[nodiscard]] double blended(const Vec3& p, std::uint32_t triangle) const {
        const Vec3f& normal = normals_[triangle];
        const VoxelIndex base = index_.nearest(p, normal);
        if (base == ShellIndex::kNone) return kBorderReach;
        if (std::abs(value_[base]) > kFarFromBorder) return static_cast<double>(value_[base]);
        double sum = 0.0, weights = 0.0;
        const auto add = [&](VoxelIndex v) {
            const double w = weight(v, p, normal, kKernel);
            if (w <= 0.0) return;
            sum += w * seen_from(v, p);
            weights += w;
        };
        add(base);
        for (std::uint32_t k = links_.first[base]; k < links_.first[base + 1]; ++k) add(links_.neighbor[k]);
        return weights > 0.0 ? sum / weights : seen_from(base, p);
    }

    const SurfaceVoxels& shell_;
    const TexelFrames& frames_;
    const RegionField& keep_;
    ShellIndex index_;
    TexelSampler sampler_;
    const GeodesicLinks& links_;
    std::vector<Vec2> origin_;
    std::vector<float> pixels_per_voxel_;
    VoxelMask trusted_;
    std::vector<float> value_;
    std::vector<Vec3f> gradient_;
    std::vector<Rgb8> own_color_;
    VoxelMask plain_;
    std::vector<Vec3f> normals_;  ///< per triangle of the mesh
};

}  // namespace

struct PatternField::Impl {
    std::function<double(const Vec3&, std::uint32_t)> distance;
    std::function<Rgb8(const Vec3&, std::uint32_t)> color;
};

PatternField::PatternField(const TriangleMesh& mesh, const SurfaceVoxels& shell, const GeodesicLinks& links,
                           const SolidStates& solid, const TexelFrames& frames, const Exemplar& exemplar,
                           const RegionField& keep, const RunControl& run, std::span<const Rgb8> kept_colors) {
    if (!kept_colors.empty() && kept_colors.size() != mesh.triangles.size())
        throw InvalidInput("pattern field: " + std::to_string(kept_colors.size()) + " kept colours for " +
                           std::to_string(mesh.triangles.size()) + " triangles");
    if (solid.size() != shell.size() || frames.size() != shell.size())
        throw InvalidInput("pattern field: " + std::to_string(solid.size()) + " states and " +
                           std::to_string(frames.size()) + " frames for " + std::to_string(shell.size()) + " voxels");
    const auto pattern = std::make_shared<const VoxelPattern>(mesh, shell, links, solid, frames, exemplar, keep, run);
    impl_ = std::make_unique<const Impl>(
        Impl{[pattern](const Vec3& p, std::uint32_t t) { return pattern->signed_distance_voxels(p, t); },
             [pattern, kept_colors, &keep](const Vec3& p, std::uint32_t t) {
                 const bool kept = !kept_colors.empty() && !keep.empty() && keep.signed_distance_mm(p, t) <= 0.0;
                 return kept ? kept_colors[t] : pattern->color(p, t);
             }});
}

PatternField::PatternField(std::function<double(const Vec3&, std::uint32_t)> signed_distance_voxels,
                           std::function<Rgb8(const Vec3&, std::uint32_t)> color)
    : impl_(std::make_unique<const Impl>(Impl{std::move(signed_distance_voxels), std::move(color)})) {}

PatternField::~PatternField() = default;
PatternField::PatternField(PatternField&&) noexcept = default;
PatternField& PatternField::operator=(PatternField&&) noexcept = default;

double PatternField::signed_distance_voxels(const Vec3& point_mm, std::uint32_t triangle) const {
    return impl_->distance(point_mm, triangle);
}

Rgb8 PatternField::color(const Vec3& point_mm, std::uint32_t triangle) const {
    return impl_->color(point_mm, triangle);
}

}  // namespace fretwork
