// Psi of the paper, section 4.1: the directions from which the exemplar is projected.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/vec.h"

namespace fretwork {

using PlaneIndex = std::uint32_t;

/// Unit normals spread over the sphere, each with a frame: right x up = normal, so that a picture
/// laid into the plane reads correctly from outside.
class PlaneSet {
  public:
    /// \param count  26 gives the directions to the faces, edges and corners of a cube, as the paper
    ///               has them; any other number, at least 6, a spiral of equal areas.
    /// \param up     the frames' up is the projection of this, where there is one
    PlaneSet(int count, const Vec3f& up);

    [[nodiscard]] std::size_t size() const { return normals_.size(); }
    [[nodiscard]] const Vec3f& normal(PlaneIndex p) const { return normals_[p]; }
    [[nodiscard]] const Vec3f& right(PlaneIndex p) const { return right_[p]; }
    [[nodiscard]] const Vec3f& up(PlaneIndex p) const { return up_[p]; }

    /// The plane whose normal is closest to `direction` (any length but zero); the lower index on a tie.
    [[nodiscard]] PlaneIndex nearest(const Vec3f& direction) const;

  private:
    std::vector<Vec3f> normals_, right_, up_;
    // Faces of a cube cut into cells; per cell the planes that are nearest to some direction in it.
    std::vector<std::uint32_t> cell_first_;
    std::vector<PlaneIndex> cell_planes_;
};

}  // namespace fretwork
