// Meshes whose exact answer is known on paper, and messy ones. All lengths in millimetres; closed ones are oriented
// outward unless said otherwise. Nothing here reads a file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace fretwork::testing {

// ---- Flat and boxy
// ---------------------------------------------------------------------------------------------------

/// [0, side]^2 in the plane z = 0, normal +z, cells x cells squares of two triangles. Area side^2. Open.
TriangleMesh make_square(double side_mm, int cells = 1);

/// Closed box. Volume and area are those of the box, exactly. Sides are split into `cells` along x, y, z.
TriangleMesh make_box(const Vec3& min_mm, const Vec3& max_mm, const std::array<int, 3>& cells = {1, 1, 1});

/// Closed box [0, width] x [0, depth] x [0, thickness], split finely across and once through.
TriangleMesh make_thin_plate(double width_mm, double depth_mm, double thickness_mm, int cells = 16);

/// The twelve bars of a cube [0, side]^3, square in section. Genus 5, volume side^3 - hole^3 - 6 hole^2 bar with
/// hole = side - 2 bar.
TriangleMesh make_frame(double side_mm, double bar_mm, int cells_per_bar = 2);

/// Block with two square holes side by side (a figure of eight), genus 2. Bars and thickness are `bar_mm`, holes
/// `hole_mm` wide. Volume bar ((3 bar + 2 hole) (2 bar + hole) - 2 hole^2).
TriangleMesh make_double_ring(double hole_mm, double bar_mm, int cells_per_bar = 2);

/// Sizes of `make_bracket`: an L of two plates of one thickness, with drilled holes.
struct BracketSize {
    double thickness_mm = 6.0;
    double panel_mm = 24.0;       ///< the base is 2 x 2 panels, the upright 2 x 1; each has one hole
    double hole_radius_mm = 6.0;  ///< below half of the panel
    int cells_per_panel = 6;      ///< each hole is a regular polygon of four times as many corners
    int cells_per_thickness = 2;
};
/// CAD part with sharp edges and flat faces. Genus 6. Corner at the origin, base in z < thickness, upright in
/// x < thickness.
TriangleMesh make_bracket(const BracketSize& size = {});
double bracket_volume_mm3(const BracketSize& size = {});

// ---- Round
// -----------------------------------------------------------------------------------------------------------

/// Sphere of `rings` bands from pole to pole and `segments` sectors; every vertex on the sphere.
TriangleMesh make_sphere(double radius_mm, int rings, int segments, const Vec3& center_mm = Vec3::Zero());

/// Icosahedron split `subdivisions` times (20 * 4^n triangles), every vertex on the sphere.
TriangleMesh make_icosphere(double radius_mm, int subdivisions, const Vec3& center_mm = Vec3::Zero());

/// Torus around z. Genus 1.
TriangleMesh make_torus(double major_mm, double minor_mm, int segments_major, int segments_minor);

/// Closed cylinder around z from z = 0 to `height_mm`. Volume n/2 sin(2 pi / n) r^2 h for n segments.
TriangleMesh make_cylinder(double radius_mm, double height_mm, int segments, int rings = 4);

/// Closed pipe around z from z = 0. Genus 1. Volume n/2 sin(2 pi / n) (R^2 - r^2) h.
TriangleMesh make_tube(double outer_radius_mm, double inner_radius_mm, double height_mm, int segments, int rings = 4);

/// Closed vase (a solid of revolution: foot, belly, neck and lip) around z from z = 0, flat bottom and top. Genus 0.
/// Widest about 0.34 heights from the axis.
TriangleMesh make_vase(double height_mm, int segments = 64, int rings = 48);
double vase_volume_mm3(double height_mm, int segments = 64, int rings = 48);

/// Half sphere z <= 0, open at the rim in the plane z = 0, seen from outside. One border loop of `segments` edges.
TriangleMesh make_open_bowl(double radius_mm, int rings, int segments);

/// Turns the polyline (r, z) around z. Points with r = 0 become poles and may stand only at the ends. A `closed`
/// profile joins its last point to its first. A profile that runs upward (dz > 0) faces outward.
/// Volume enclosed: n/2 sin(2 pi / n) times the integral of r^2 dz along the profile, exactly.
TriangleMesh revolve(const std::vector<Vec2>& profile_mm, int segments, bool closed);

// ---- Several components
// ----------------------------------------------------------------------------------------------

/// Two linked tori that never touch: two components, genus 1 each.
TriangleMesh make_linked_tori(double major_mm, double minor_mm, int segments_major = 48, int segments_minor = 24);

/// Icosphere with a hollow: the inner sphere faces inward, so that the volume is the difference.
TriangleMesh make_nested_spheres(double outer_mm, double inner_mm, int subdivisions = 3);

/// All of `a`, then all of `b`; nothing is shared.
TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b);

// ---- Messy
// -----------------------------------------------------------------------------------------------------------

/// Every triangle with three vertices of its own.
TriangleMesh as_soup(const TriangleMesh& mesh);
/// All triangles turned round: inside out.
TriangleMesh inverted(const TriangleMesh& mesh);
/// Every n-th triangle turned round.
TriangleMesh with_flipped(const TriangleMesh& mesh, std::size_t every);
/// The first `count` triangles once more, the odd ones turned round.
TriangleMesh with_duplicates(const TriangleMesh& mesh, std::size_t count);
/// `count` further triangles of zero area: a repeated index, a repeated position and three points in line, in turn.
TriangleMesh with_degenerates(const TriangleMesh& mesh, std::size_t count);
/// Without the triangles [first, first + count).
TriangleMesh without_triangles(const TriangleMesh& mesh, std::size_t first, std::size_t count);
/// The same surface with triangles and vertices in another order, and each triangle rotated; depends on `seed` only.
TriangleMesh shuffled(const TriangleMesh& mesh, std::uint64_t seed);

/// Two triangles that pass through each other: one self-intersecting pair.
TriangleMesh make_crossing_pair();
/// Two closed cubes of side 2 that overlap in a cube of side 1: two components, self-intersecting.
TriangleMesh make_overlapping_boxes();
/// Two closed unit cubes that share the four vertices of nothing but one edge: the edge has four triangles.
TriangleMesh make_boxes_sharing_edge();
/// Three triangles on one edge. Open.
TriangleMesh make_three_fins();
/// Two closed tetrahedra that share one vertex.
TriangleMesh make_pinched_vertex();
/// `triangles` random triangles with corners in [-extent, extent]^3.
TriangleMesh random_soup(std::uint64_t seed, std::size_t triangles, double extent_mm);

// ---- Moved and measured
// ----------------------------------------------------------------------------------------------

TriangleMesh translated(TriangleMesh mesh, const Vec3& by_mm);
TriangleMesh scaled(TriangleMesh mesh, double factor);
/// Turned about `axis` through the origin.
TriangleMesh rotated(TriangleMesh mesh, const Vec3& axis, double angle_rad);

double area_mm2(const TriangleMesh& mesh);
/// By the divergence theorem; negative when inside out. Meaningful for closed meshes.
double volume_mm3(const TriangleMesh& mesh);

/// (n/2) sin(2 pi / n): what stands for pi in a prism of n sides.
double polygon_pi(int segments);

}  // namespace fretwork::testing
