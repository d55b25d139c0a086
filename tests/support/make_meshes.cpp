#include "support/make_meshes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/base/counter_random.h"
#include "support/block_mesh.h"

namespace fretwork::testing {
namespace {

constexpr double kPi = std::numbers::pi;

std::uint32_t index_of(std::size_t i) {
    return static_cast<std::uint32_t>(i);
}

/// Adds a quad a, b, c, d (counter-clockwise) as two triangles.
void add_quad(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
}

/// Straight from `a` to `b` in `parts` steps, without `a`.
void line_to(std::vector<Vec2>& profile, const Vec2& b, int parts) {
    const Vec2 a = profile.back();
    for (int i = 1; i < parts; ++i) profile.push_back(a + (b - a) * i / parts);
    profile.push_back(b);
}

std::vector<Vec2> vase_profile(double height_mm, int rings) {
    // Foot, belly, neck and lip as one smooth curve of the height.
    const auto radius = [](double u) {
        return 0.2 + 0.14 * std::sin(kPi * std::pow(u, 0.8) * 1.55 - 0.25) * (1.0 - 0.25 * u) + 0.05 * u * u * u;
    };
    std::vector<Vec2> profile = {Vec2(0.0, 0.0)};
    const int cap = std::max(2, rings / 8);
    line_to(profile, Vec2(radius(0.0) * height_mm, 0.0), cap);
    for (int i = 1; i <= rings; ++i) {
        const double u = static_cast<double>(i) / rings;
        profile.emplace_back(radius(u) * height_mm, u * height_mm);
    }
    line_to(profile, Vec2(0.0, height_mm), cap);
    return profile;
}

/// Integral of r^2 dz along a polyline, exact for its straight pieces.
double integral_r2_dz(const std::vector<Vec2>& profile) {
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        const Vec2 &a = profile[i], &b = profile[i + 1];
        sum += (b[1] - a[1]) * (a[0] * a[0] + a[0] * b[0] + b[0] * b[0]) / 3.0;
    }
    return sum;
}

std::vector<std::size_t> shuffled_order(std::size_t count, std::uint64_t seed, std::uint32_t epoch) {
    std::vector<std::pair<std::uint64_t, std::size_t>> keys(count);
    for (std::size_t i = 0; i < count; ++i) keys[i] = {counter_random(seed, RandomStream::kTest, epoch, i, 0), i};
    std::sort(keys.begin(), keys.end());
    std::vector<std::size_t> order(count);
    for (std::size_t i = 0; i < count; ++i) order[i] = keys[i].second;
    return order;
}

}  // namespace

double polygon_pi(int segments) {
    return 0.5 * segments * std::sin(2.0 * kPi / segments);
}

TriangleMesh make_square(double side_mm, int cells) {
    TriangleMesh mesh;
    const auto n = index_of(static_cast<std::size_t>(cells));
    if (cells == 1) {  // Corners in order round the square, so that tests can name them.
        mesh.positions_mm = {{0, 0, 0}, {side_mm, 0, 0}, {side_mm, side_mm, 0}, {0, side_mm, 0}};
        add_quad(mesh, 0, 1, 2, 3);
        return mesh;
    }
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) mesh.positions_mm.emplace_back(side_mm * i / n, side_mm * j / n, 0.0);
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i;
            add_quad(mesh, a, a + 1, a + n + 2, a + n + 1);
        }
    return mesh;
}

TriangleMesh make_box(const Vec3& min_mm, const Vec3& max_mm, const std::array<int, 3>& cells) {
    BlockLattice lattice;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        lattice.lines_mm[axis] = {min_mm[a], max_mm[a]};
        lattice.cells[axis] = {cells[axis]};
    }
    return block_mesh(lattice, [](const std::array<int, 3>&) { return Block::solid(); });
}

TriangleMesh make_thin_plate(double width_mm, double depth_mm, double thickness_mm, int cells) {
    return make_box(Vec3::Zero(), Vec3(width_mm, depth_mm, thickness_mm), {cells, cells, 1});
}

TriangleMesh make_frame(double side_mm, double bar_mm, int cells_per_bar) {
    BlockLattice lattice;
    const int across = std::max(1, static_cast<int>(std::lround((side_mm - 2 * bar_mm) / bar_mm * cells_per_bar)));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lattice.lines_mm[axis] = {0.0, bar_mm, side_mm - bar_mm, side_mm};
        lattice.cells[axis] = {cells_per_bar, across, cells_per_bar};
    }
    return block_mesh(lattice, [](const std::array<int, 3>& b) {
        const auto middles = std::count(b.begin(), b.end(), 1);
        return middles <= 1 ? Block::solid() : Block::empty();
    });
}

TriangleMesh make_double_ring(double hole_mm, double bar_mm, int cells_per_bar) {
    const int across = std::max(1, static_cast<int>(std::lround(hole_mm / bar_mm * cells_per_bar)));
    const int c = cells_per_bar;
    BlockLattice lattice;
    lattice.lines_mm[0] = {
        0.0, bar_mm, bar_mm + hole_mm, 2 * bar_mm + hole_mm, 2 * bar_mm + 2 * hole_mm, 3 * bar_mm + 2 * hole_mm};
    lattice.lines_mm[1] = {0.0, bar_mm, bar_mm + hole_mm, 2 * bar_mm + hole_mm};
    lattice.lines_mm[2] = {0.0, bar_mm};
    lattice.cells = {{{c, across, c, across, c}, {c, across, c}, {c}}};
    return block_mesh(lattice, [](const std::array<int, 3>& b) {
        return b[1] == 1 && (b[0] == 1 || b[0] == 3) ? Block::empty() : Block::solid();
    });
}

TriangleMesh make_bracket(const BracketSize& size) {
    const double t = size.thickness_mm, s = size.panel_mm;
    const int k = size.cells_per_panel, kt = size.cells_per_thickness;
    BlockLattice lattice;
    lattice.lines_mm = {{{0.0, t, t + s, t + 2 * s}, {0.0, s, 2 * s}, {0.0, t, t + s}}};
    lattice.cells = {{{kt, k, k}, {k, k}, {kt, k}}};
    lattice.hole_radius_mm = size.hole_radius_mm;
    return block_mesh(lattice, [](const std::array<int, 3>& b) {
        if (b[0] > 0 && b[2] == 0) return Block::drilled(2);   // base
        if (b[0] == 0 && b[2] == 1) return Block::drilled(0);  // upright
        return b[0] == 0 && b[2] == 0 ? Block::solid() : Block::empty();
    });
}

double bracket_volume_mm3(const BracketSize& size) {
    const double t = size.thickness_mm, s = size.panel_mm, r = size.hole_radius_mm;
    const double hole = polygon_pi(4 * size.cells_per_panel) * r * r * t;
    return 2 * s * t * (t + 2 * s) + 2 * s * t * s - 6 * hole;
}

TriangleMesh revolve(const std::vector<Vec2>& profile_mm, int segments, bool closed) {
    TriangleMesh mesh;
    const auto n = static_cast<std::uint32_t>(segments);
    std::vector<std::uint32_t> first(profile_mm.size());
    std::vector<bool> pole(profile_mm.size());
    for (std::size_t i = 0; i < profile_mm.size(); ++i) {
        const double r = profile_mm[i][0], z = profile_mm[i][1];
        first[i] = index_of(mesh.positions_mm.size());
        pole[i] = r == 0.0;
        for (std::uint32_t s = 0; s < (pole[i] ? 1 : n); ++s) {
            const double angle = 2.0 * kPi * s / n;
            mesh.positions_mm.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
        }
    }
    const std::size_t bands = closed ? profile_mm.size() : profile_mm.size() - 1;
    for (std::size_t i = 0; i < bands; ++i) {
        const std::size_t j = (i + 1) % profile_mm.size();
        for (std::uint32_t s = 0; s < n; ++s) {
            const std::uint32_t next = (s + 1) % n;
            if (pole[i])
                mesh.triangles.push_back({first[i], first[j] + next, first[j] + s});
            else if (pole[j])
                mesh.triangles.push_back({first[i] + s, first[i] + next, first[j]});
            else
                add_quad(mesh, first[i] + s, first[i] + next, first[j] + next, first[j] + s);
        }
    }
    return mesh;
}

TriangleMesh make_sphere(double radius_mm, int rings, int segments, const Vec3& center_mm) {
    std::vector<Vec2> profile = {Vec2(0.0, -radius_mm)};
    for (int i = 1; i < rings; ++i) {
        const double angle = kPi * i / rings;
        profile.emplace_back(radius_mm * std::sin(angle), -radius_mm * std::cos(angle));
    }
    profile.emplace_back(0.0, radius_mm);
    return translated(revolve(profile, segments, false), center_mm);
}

TriangleMesh make_icosphere(double radius_mm, int subdivisions, const Vec3& center_mm) {
    const double g = std::numbers::phi;
    TriangleMesh mesh;
    mesh.positions_mm = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                         {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (int level = 0; level < subdivisions; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
        const auto mid = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, fresh] = middle.try_emplace(std::minmax(a, b), index_of(mesh.positions_mm.size()));
            if (fresh) mesh.positions_mm.push_back((mesh.positions_mm[a] + mesh.positions_mm[b]).normalized());
            return at->second;
        };
        if (level == 0)
            for (Vec3& p : mesh.positions_mm) p.normalize();
        std::vector<Triangle> finer;
        for (const Triangle& t : mesh.triangles) {
            const std::uint32_t a = mid(t[0], t[1]), b = mid(t[1], t[2]), c = mid(t[2], t[0]);
            finer.insert(finer.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
        }
        mesh.triangles = std::move(finer);
    }
    for (Vec3& p : mesh.positions_mm) p = center_mm + radius_mm * p.normalized();
    return mesh;
}

TriangleMesh make_torus(double major_mm, double minor_mm, int segments_major, int segments_minor) {
    std::vector<Vec2> profile;
    for (int i = 0; i < segments_minor; ++i) {
        const double angle = 2.0 * kPi * i / segments_minor;
        profile.emplace_back(major_mm + minor_mm * std::cos(angle), minor_mm * std::sin(angle));
    }
    return revolve(profile, segments_major, true);
}

TriangleMesh make_cylinder(double radius_mm, double height_mm, int segments, int rings) {
    std::vector<Vec2> profile = {Vec2(0.0, 0.0)};
    line_to(profile, Vec2(radius_mm, 0.0), rings);
    line_to(profile, Vec2(radius_mm, height_mm), rings);
    line_to(profile, Vec2(0.0, height_mm), rings);
    return revolve(profile, segments, false);
}

TriangleMesh make_tube(double outer_radius_mm, double inner_radius_mm, double height_mm, int segments, int rings) {
    std::vector<Vec2> profile = {Vec2(outer_radius_mm, 0.0)};
    line_to(profile, Vec2(outer_radius_mm, height_mm), rings);
    line_to(profile, Vec2(inner_radius_mm, height_mm), rings);
    line_to(profile, Vec2(inner_radius_mm, 0.0), rings);
    line_to(profile, Vec2(outer_radius_mm, 0.0), rings);
    profile.pop_back();
    return revolve(profile, segments, true);
}

TriangleMesh make_vase(double height_mm, int segments, int rings) {
    return revolve(vase_profile(height_mm, rings), segments, false);
}

double vase_volume_mm3(double height_mm, int segments, int rings) {
    return polygon_pi(segments) * integral_r2_dz(vase_profile(height_mm, rings));
}

TriangleMesh make_open_bowl(double radius_mm, int rings, int segments) {
    std::vector<Vec2> profile = {Vec2(0.0, -radius_mm)};
    for (int i = 1; i < rings; ++i) {
        const double angle = 0.5 * kPi * i / rings;
        profile.emplace_back(radius_mm * std::sin(angle), -radius_mm * std::cos(angle));
    }
    profile.emplace_back(radius_mm, 0.0);
    return revolve(profile, segments, false);
}

TriangleMesh make_linked_tori(double major_mm, double minor_mm, int segments_major, int segments_minor) {
    const TriangleMesh ring = make_torus(major_mm, minor_mm, segments_major, segments_minor);
    return joined(ring, translated(rotated(ring, Vec3::UnitX(), 0.5 * kPi), Vec3(major_mm, 0, 0)));
}

TriangleMesh make_nested_spheres(double outer_mm, double inner_mm, int subdivisions) {
    return joined(make_icosphere(outer_mm, subdivisions), inverted(make_icosphere(inner_mm, subdivisions)));
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
    TriangleMesh both = a;
    const std::uint32_t shift = index_of(a.positions_mm.size());
    both.positions_mm.insert(both.positions_mm.end(), b.positions_mm.begin(), b.positions_mm.end());
    for (const Triangle& t : b.triangles) both.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    return both;
}

TriangleMesh as_soup(const TriangleMesh& mesh) {
    TriangleMesh soup;
    for (const Triangle& t : mesh.triangles) {
        const std::uint32_t first = index_of(soup.positions_mm.size());
        for (const std::uint32_t v : t) soup.positions_mm.push_back(mesh.positions_mm[v]);
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    return soup;
}

TriangleMesh inverted(const TriangleMesh& mesh) {
    return with_flipped(mesh, 1);
}

TriangleMesh with_flipped(const TriangleMesh& mesh, std::size_t every) {
    TriangleMesh flipped = mesh;
    for (std::size_t t = 0; t < flipped.triangles.size(); t += every)
        std::swap(flipped.triangles[t][1], flipped.triangles[t][2]);
    return flipped;
}

TriangleMesh with_duplicates(const TriangleMesh& mesh, std::size_t count) {
    TriangleMesh twice = mesh;
    for (std::size_t i = 0; i < count; ++i) {
        const Triangle t = mesh.triangles[i % mesh.triangles.size()];
        twice.triangles.push_back(i % 2 == 0 ? Triangle{t[1], t[2], t[0]} : Triangle{t[1], t[0], t[2]});
    }
    return twice;
}

TriangleMesh with_degenerates(const TriangleMesh& mesh, std::size_t count) {
    TriangleMesh more = mesh;
    for (std::size_t i = 0; i < count; ++i) {
        const Triangle t = mesh.triangles[i % mesh.triangles.size()];
        const std::uint32_t fresh = index_of(more.positions_mm.size());
        const Vec3 a = mesh.positions_mm[t[0]];
        if (i % 3 == 0) {
            more.triangles.push_back({t[0], t[1], t[1]});
        } else if (i % 3 == 1) {
            more.positions_mm.push_back(a);
            more.triangles.push_back({t[0], t[1], fresh});
        } else {  // On a line along an axis, where the midpoint is exact.
            more.positions_mm.insert(more.positions_mm.end(), {a, a + Vec3(1, 0, 0), a + Vec3(2, 0, 0)});
            more.triangles.push_back({fresh, fresh + 1, fresh + 2});
        }
    }
    return more;
}

TriangleMesh without_triangles(const TriangleMesh& mesh, std::size_t first, std::size_t count) {
    TriangleMesh less = mesh;
    const auto begin = less.triangles.begin() + static_cast<std::ptrdiff_t>(first);
    less.triangles.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
    return less;
}

TriangleMesh shuffled(const TriangleMesh& mesh, std::uint64_t seed) {
    const std::vector<std::size_t> vertex_order = shuffled_order(mesh.positions_mm.size(), seed, 0);
    const std::vector<std::size_t> triangle_order = shuffled_order(mesh.triangles.size(), seed, 1);
    std::vector<std::uint32_t> moved(mesh.positions_mm.size());
    TriangleMesh out;
    for (const std::size_t v : vertex_order) {
        moved[v] = index_of(out.positions_mm.size());
        out.positions_mm.push_back(mesh.positions_mm[v]);
    }
    for (const std::size_t i : triangle_order) {
        Triangle t = mesh.triangles[i];
        std::rotate(t.begin(), t.begin() + i % 3, t.end());
        out.triangles.push_back({moved[t[0]], moved[t[1]], moved[t[2]]});
    }
    return out;
}

TriangleMesh make_crossing_pair() {
    return {{{-2, -1, 0}, {2, -1, 0}, {0, 2, 0}, {0, 0, -1}, {0, 0, 1}, {0, 5, 0.25}}, {{0, 1, 2}, {3, 4, 5}}};
}

TriangleMesh make_overlapping_boxes() {
    return joined(make_box(Vec3::Zero(), Vec3(2, 2, 2)), make_box(Vec3(1, 1, 1), Vec3(3, 3, 3)));
}

TriangleMesh make_boxes_sharing_edge() {
    BlockLattice lattice;
    lattice.lines_mm = {{{0.0, 1.0, 2.0}, {0.0, 1.0, 2.0}, {0.0, 1.0}}};
    lattice.cells = {{{1, 1}, {1, 1}, {1}}};
    return block_mesh(lattice,
                      [](const std::array<int, 3>& b) { return b[0] == b[1] ? Block::solid() : Block::empty(); });
}

TriangleMesh make_three_fins() {
    return {{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
}

TriangleMesh make_pinched_vertex() {
    return {{{0, 0, 0}, {1, 0, 1}, {0, 1, 1}, {-1, -1, 1}, {1, 0, -1}, {0, 1, -1}, {-1, -1, -1}},
            {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}, {0, 4, 5}, {0, 5, 6}, {0, 6, 4}, {4, 6, 5}}};
}

TriangleMesh random_soup(std::uint64_t seed, std::size_t triangles, double extent_mm) {
    TriangleMesh mesh;
    for (std::size_t v = 0; v < 3 * triangles; ++v) {
        Vec3 p;
        for (std::uint32_t axis = 0; axis < 3; ++axis)
            p[axis] = extent_mm * (2.0 * unit_interval(counter_random(seed, RandomStream::kTest, 2, v, axis)) - 1.0);
        mesh.positions_mm.push_back(p);
    }
    for (std::size_t t = 0; t < triangles; ++t) {
        const std::uint32_t first = index_of(3 * t);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

TriangleMesh translated(TriangleMesh mesh, const Vec3& by_mm) {
    for (Vec3& p : mesh.positions_mm) p += by_mm;
    return mesh;
}

TriangleMesh scaled(TriangleMesh mesh, double factor) {
    for (Vec3& p : mesh.positions_mm) p *= factor;
    return mesh;
}

TriangleMesh rotated(TriangleMesh mesh, const Vec3& axis, double angle_rad) {
    const Vec3 u = axis.normalized();
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    for (Vec3& p : mesh.positions_mm) p = (c * p + s * u.cross(p) + (1.0 - c) * u.dot(p) * u).eval();
    return mesh;
}

double area_mm2(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.positions_mm[t[0]];
        sum += 0.5 * (mesh.positions_mm[t[1]] - a).cross(mesh.positions_mm[t[2]] - a).norm();
    }
    return sum;
}

double volume_mm3(const TriangleMesh& mesh) {
    // About a vertex rather than the origin, so that a far-away mesh loses no digits.
    const Vec3 origin = mesh.positions_mm.empty() ? Vec3(Vec3::Zero()) : mesh.positions_mm.front();
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.positions_mm[t[0]] - origin;
        sum += a.dot((mesh.positions_mm[t[1]] - origin).cross(mesh.positions_mm[t[2]] - origin)) / 6.0;
    }
    return sum;
}

}  // namespace fretwork::testing
