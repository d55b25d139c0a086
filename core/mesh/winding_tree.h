// Generalised winding number of any triangle soup.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec.h"

namespace fretwork {

/// Sums the solid angles of \cite jacobson2013robust: near triangles exactly, far groups by the first three terms of
/// the expansion of \cite barill2018fast. Groups halve along a space-filling curve; one is far when the point is more
/// than twice its radius away. Error below 0.01, usually 0.001; cost grows with the logarithm of the size.
class WindingTree {
  public:
    struct Corners {
        Vec3 a, b, c;
    };
    /// \param triangles  at least one
    explicit WindingTree(std::vector<Corners> triangles);
    [[nodiscard]] double at(const Vec3& point_mm) const;

  private:
    struct Group {
        Vec3 center;
        // Moments over the group's surface of the area vector n and the offset d from the centre.
        Vec3 area;                     ///< integral of n
        Eigen::Matrix3d moment;        ///< of d n^T
        Vec3 squared;                  ///< of 2 (n.d) d + |d|^2 n
        std::array<double, 10> cubic;  ///< of (n.r) (d.r)^2 as a polynomial of r; order in add_moments
        double radius;
        std::uint32_t begin, end;
        std::uint32_t next;  ///< the group after this one's descendants
    };
    void build(std::uint32_t begin, std::uint32_t end);
    static void add_moments(Group& g, const Vec3& n, const Vec3& d);
    /// Winding number of the group round the point from which its centre is seen at `r`.
    [[nodiscard]] static double from_afar(const Group& g, const Vec3& r);
    [[nodiscard]] Group summary(std::uint32_t begin, std::uint32_t end) const;

    std::vector<Corners> triangles_;  ///< along the curve
    std::vector<Group> groups_;       ///< depth first
};

}  // namespace fretwork
