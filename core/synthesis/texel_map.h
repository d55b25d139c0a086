// Positions in the exemplar as 32-bit shares of its period, so that wrapping costs nothing and every
// instruction set computes the same bits.
#pragma once

#include <cstdint>

#include "core/base/fixed_point.h"
#include "core/base/vec.h"

namespace fretwork {

/// A position in the exemplar: u to the right, v downwards; 2^32 is one period.
struct TexelPosition {
    std::uint32_t u = 0;
    std::uint32_t v = 0;
};

/// The linear part of M(x, psi, tau), section 4.1: the vectors u(tau) and v(tau), quantised.
struct LinearPart {
    std::int32_t u_xy = 0;  ///< x and y of u(tau)
    std::int32_t v_xy = 0;  ///< x and y of v(tau)
    std::int32_t uv_z = 0;  ///< z of both
};

/// A difference of positions in cells of a level, 12 fractional bits.
struct LevelOffset {
    std::int32_t xy = 0;
    std::int32_t z = 0;  ///< low half; the high half is zero
};

/// A surface point in finest voxels, those of the full run in a draft, 12 fractional bits.
struct FixedPoint {
    std::int32_t x = 0, y = 0, z = 0;

    friend bool operator==(const FixedPoint&, const FixedPoint&) = default;
};

/// \param skipped_levels  SynthesisSettings
[[nodiscard]] FixedPoint to_fixed(const Vec3f& position_voxels, int skipped_levels = 0);

/// Converts between pixels, shares of the period and voxels for one exemplar and one scale.
///
/// A linear part holds (pixels per voxel) * 2^bits / size, at most 2^15. With offsets of 12
/// fractional bits on level l a product is short of a share of 2^32 by 20 - bits + l binary places.
class TexelMap {
  public:
    TexelMap() = default;
    /// A draft computes with the integers of the full run, so that the two agree.
    /// \param pixels_per_voxel  |u(tau)| = |v(tau)|
    /// \param skipped_levels    SynthesisSettings
    TexelMap(int width, int height, double pixels_per_voxel, int skipped_levels = 0);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] double pixels_per_voxel() const { return pixels_per_voxel_; }
    /// Binary places by which a projected offset of a level is short of a share of 2^32.
    [[nodiscard]] int u_shift(int level) const { return u_place_shift() + skipped_levels_ + level; }
    [[nodiscard]] int v_shift(int level) const { return v_place_shift() + skipped_levels_ + level; }
    /// The same of a projected point.
    [[nodiscard]] int u_place_shift() const { return 20 - u_bits_; }
    [[nodiscard]] int v_place_shift() const { return 20 - v_bits_; }

    /// \param right, up  unit vectors of the plane; the picture's rows run downwards
    [[nodiscard]] LinearPart linear_part(const Vec3f& right, const Vec3f& up) const {
        return {pack16(quantize(right.x(), u_unit_), quantize(right.y(), u_unit_)),
                pack16(quantize(up.x(), -v_unit_), quantize(up.y(), -v_unit_)),
                pack16(quantize(right.z(), u_unit_), quantize(up.z(), -v_unit_))};
    }

    /// Linear part applied to a surface point; add the label's origin to get M.
    [[nodiscard]] TexelPosition project(const LinearPart& part, const FixedPoint& p) const {
        return {dot(low16(part.u_xy), high16(part.u_xy), low16(part.uv_z), p) << u_place_shift(),
                dot(low16(part.v_xy), high16(part.v_xy), high16(part.uv_z), p) << v_place_shift()};
    }

    /// Linear part applied to an offset of level `level`.
    [[nodiscard]] TexelPosition project(const LinearPart& part, const LevelOffset& d, int level) const {
        const std::int32_t x = low16(d.xy), y = high16(d.xy), z = low16(d.z);
        const std::int32_t u = low16(part.u_xy) * x + high16(part.u_xy) * y + low16(part.uv_z) * z;
        const std::int32_t v = low16(part.v_xy) * x + high16(part.v_xy) * y + high16(part.uv_z) * z;
        return {static_cast<std::uint32_t>(u) << u_shift(level), static_cast<std::uint32_t>(v) << v_shift(level)};
    }

    /// u(tau), v(tau) in pixels per voxel.
    [[nodiscard]] Vec3f u_vector(const LinearPart& part) const {
        return Vec3f(static_cast<float>(low16(part.u_xy)), static_cast<float>(high16(part.u_xy)),
                     static_cast<float>(low16(part.uv_z))) *
               u_pixels_;
    }
    [[nodiscard]] Vec3f v_vector(const LinearPart& part) const {
        return Vec3f(static_cast<float>(low16(part.v_xy)), static_cast<float>(high16(part.v_xy)),
                     static_cast<float>(high16(part.uv_z))) *
               v_pixels_;
    }

    /// Column, row and index of the pixel that holds a position. Only the upper 16 bits count.
    [[nodiscard]] std::uint32_t column(std::uint32_t u) const {
        return ((u >> 16) * static_cast<std::uint32_t>(width_)) >> 16;
    }
    [[nodiscard]] std::uint32_t row(std::uint32_t v) const {
        return ((v >> 16) * static_cast<std::uint32_t>(height_)) >> 16;
    }
    [[nodiscard]] std::uint32_t pixel(const TexelPosition& t) const {
        return column(t.u) + row(t.v) * static_cast<std::uint32_t>(width_);
    }

  private:
    [[nodiscard]] static std::int32_t quantize(float component, float unit) { return round_to_int(component * unit); }
    [[nodiscard]] static std::uint32_t dot(std::int32_t x, std::int32_t y, std::int32_t z, const FixedPoint& p) {
        // Modulo 2^32 on purpose: whole periods drop out.
        return static_cast<std::uint32_t>(x) * static_cast<std::uint32_t>(p.x) +
               static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(p.y) +
               static_cast<std::uint32_t>(z) * static_cast<std::uint32_t>(p.z);
    }

    int width_ = 1, height_ = 1;
    double pixels_per_voxel_ = 1.0;
    int skipped_levels_ = 0;
    int u_bits_ = 0, v_bits_ = 0;
    float u_unit_ = 0.0F, v_unit_ = 0.0F;      // quantised units per unit of direction
    float u_pixels_ = 0.0F, v_pixels_ = 0.0F;  // pixels per voxel per quantised unit
};

}  // namespace fretwork
