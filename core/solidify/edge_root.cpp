#include "core/solidify/edge_root.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fretwork {
namespace {

/// Roots are good to this many voxels of f; the mesh's own curvature between vertices is a hundred times that.
constexpr double kResidual = 1e-3;
constexpr int kMaxSteps = 7;

class EdgeSearch {
  public:
    EdgeSearch(const WallField& field, const EdgeEnd& inside, const EdgeEnd& outside)
        : field_(field),
          inside_(inside),
          outside_(outside),
          solid_(std::max(inside.pattern, outside.pattern) < WallField::surely_solid()) {
        last_.triangle = inside.triangle;
        const bool crosses = field.limits().signed_distance && (inside.phi < 0.0) != (outside.phi < 0.0);
        if (crosses) {
            if (const auto hit = field.tree().first_hit(inside.position_mm, outside.position_mm)) {
                switch_at_ = hit->parameter;
                switch_triangle_ = hit->triangle;
            } else {
                switch_at_ = inside.phi / (inside.phi - outside.phi);
                switch_triangle_ = inside.triangle;
            }
        }
    }

    WallVertex find(double clamp) {
        low_ = 0.0;
        high_ = 1.0;
        f_low_ = std::max(field_.limits().slab(inside_.phi), inside_.pattern);
        f_high_ = std::max(field_.limits().slab(outside_.phi), outside_.pattern);
        WallVertex v;
        if (switch_at_ && field_.limits().touches_surface() && stop_at_surface(v)) {
            place(v, *switch_at_, clamp);
            return v;
        }
        const double s = search();
        v.face = field_.face(last_.phi, last_.pattern);
        v.triangle = last_.triangle;
        if (v.face != WallFace::kPattern) v.normal = face_normal(v.face, at(s));
        place(v, s, clamp);
        return v;
    }

  private:
    [[nodiscard]] Vec3 at(double s) const {
        return inside_.position_mm + s * (outside_.position_mm - inside_.position_mm);
    }

    void place(WallVertex& v, double s, double clamp) const { v.position_mm = at(std::clamp(s, clamp, 1.0 - clamp)); }

    /// True if the edge leaves the wall through the input surface. If it has left through the side of a hole before,
    /// the hit becomes the outer bracket.
    bool stop_at_surface(WallVertex& v) {
        const bool surface_is_upper = field_.limits().upper == 0.0;
        const double beyond = surface_is_upper ? outside_.phi : -outside_.phi;
        if (beyond < 0.0) return false;
        const double pattern =
            solid_ ? std::max(inside_.pattern, outside_.pattern) : field_.pattern_at(at(*switch_at_), switch_triangle_);
        if (pattern <= 0.0) {
            v.face = surface_is_upper ? WallFace::kUpper : WallFace::kLower;
            v.triangle = switch_triangle_;
            v.normal = (surface_is_upper ? 1.0F : -1.0F) * field_.triangle_normal(switch_triangle_).cast<float>();
            return true;
        }
        high_ = *switch_at_;
        f_high_ = pattern;
        return false;
    }

    [[nodiscard]] double sign_at(double s) const {
        const double sign_inside = inside_.phi < 0.0 ? -1.0 : 1.0;
        return switch_at_ && s > *switch_at_ ? -sign_inside : sign_inside;
    }

    /// The surface is no farther from a point of the edge than by way of an end.
    [[nodiscard]] double reach(double s) const {
        const double length = (outside_.position_mm - inside_.position_mm).norm() / field_.voxel_mm();
        return std::min(std::abs(inside_.phi) + s * length, std::abs(outside_.phi) + (1.0 - s) * length) + 1e-4;
    }

    /// Where f jumps, as the pattern does between two sheets that meet, the surface is that of the sheet inside.
    double settle_inside() {
        const WallSample s = field_.sample(at(low_), sign_at(low_), last_.triangle, reach(low_));
        if (s.found) last_ = s;
        return low_;
    }

    double search() {
        double s = low_;
        int side = 0;
        double width = high_ - low_;
        for (int step = 0; step < kMaxSteps; ++step) {
            double share = f_low_ / (f_low_ - f_high_);
            if (!(share > 0.0 && share < 1.0)) share = 0.5;
            // When the bracket hardly shrinks, f jumps or kinks in it: halve.
            if (step >= 3 && high_ - low_ > 0.5 * width) share = 0.5;
            width = high_ - low_;
            s = low_ + share * (high_ - low_);
            last_ = solid_ ? field_.sample_slab(at(s), sign_at(s), last_.triangle, reach(s),
                                                std::max(inside_.pattern, outside_.pattern))
                           : field_.sample(at(s), sign_at(s), last_.triangle, reach(s));
            if (!last_.found) break;
            const double f = field_.value(last_);
            if (std::abs(f) < kResidual) break;
            if (f < 0.0) {
                low_ = s;
                f_low_ = f;
                if (side == -1) f_high_ *= 0.5;
                side = -1;
            } else {
                high_ = s;
                f_high_ = f;
                if (side == 1) f_low_ *= 0.5;
                side = 1;
            }
            if (step + 1 == kMaxSteps) return settle_inside();
        }
        return s;
    }

    [[nodiscard]] Vec3f face_normal(WallFace face, const Vec3& p) const {
        Vec3 n = p - last_.closest_mm;
        const double length = n.norm();
        if (length < 1e-6 * field_.voxel_mm()) {
            n = field_.triangle_normal(last_.triangle);
        } else {
            n /= last_.phi < 0.0 ? -length : length;
        }
        if (face == WallFace::kLower) n = -n;
        return n.cast<float>();
    }

    const WallField& field_;
    const EdgeEnd& inside_;
    const EdgeEnd& outside_;
    bool solid_;                       ///< far from every border of the pattern, which need not be asked again
    std::optional<double> switch_at_;  ///< where phi changes sign
    std::uint32_t switch_triangle_ = 0;
    double low_ = 0.0, high_ = 1.0, f_low_ = -1.0, f_high_ = 1.0;
    WallSample last_;
};

}  // namespace

WallVertex edge_root(const WallField& field, const EdgeEnd& inside, const EdgeEnd& outside, double clamp) {
    return EdgeSearch(field, inside, outside).find(clamp);
}

}  // namespace fretwork
