#include "core/solidify/simplify.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "core/base/parallel.h"
#include "core/mesh/self_intersections.h"
#include "core/mesh/triangle_math.h"
#include "core/solidify/collapse_mesh.h"

namespace fretwork {
namespace {

using Corner = CollapseMesh::Corner;
constexpr std::uint32_t kNone = CollapseMesh::kNone;

/// Shares of the tolerance that the sweeps of a pass allow, so that what costs nothing goes first.
constexpr std::array<double, 7> kSweeps = {0.05, 0.2, 0.4, 0.7, 1.0, 1.0, 1.0};
constexpr int kPasses = 3;
constexpr int kRepairs = 6;
constexpr int kDoublings = 7;

/// A triangle may turn by up to 60 degrees in one collapse, and must stay this good: 4 sqrt 3 area / sum of squared
/// sides, 1 for an equilateral one. One that was worse before may stay as bad.
constexpr double kTurnCosine = 0.5;
constexpr double kLeastQuality = 0.03;

/// Two neighbouring triangles closer to face to face than this are as good as folded over.
constexpr double kFoldCosine = -0.95;

/// More samples than this in one ring would cost more than the triangles it saves.
constexpr std::size_t kMostSamples = 1000;

struct Shape {
    Vec3 normal;
    double quality;
};

Shape shape_of(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 n = (b - a).cross(c - a);
    const double length = n.norm();
    const double sides = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
    return {length > 0.0 ? Vec3(n / length) : Vec3(Vec3::Zero()),
            sides > 0.0 ? 2.0 * std::sqrt(3.0) * length / sides : 0.0};
}

/// Whether a side of one of two triangles passes through the other one away from what they share.
bool meet(const CollapseMesh& mesh, const Triangle& s, const Triangle& t) {
    const auto at = [&](std::uint32_t v) -> const Vec3& { return mesh.position(v); };
    const Vec3 low_s = at(s[0]).cwiseMin(at(s[1])).cwiseMin(at(s[2])),
               high_s = at(s[0]).cwiseMax(at(s[1])).cwiseMax(at(s[2]));
    const Vec3 low_t = at(t[0]).cwiseMin(at(t[1])).cwiseMin(at(t[2])),
               high_t = at(t[0]).cwiseMax(at(t[1])).cwiseMax(at(t[2]));
    if ((low_s.array() > high_t.array()).any() || (low_t.array() > high_s.array()).any()) return false;
    const auto has = [](const Triangle& x, std::uint32_t v) { return x[0] == v || x[1] == v || x[2] == v; };
    int shared = 0;
    for (const std::uint32_t v : s) shared += has(t, v) ? 1 : 0;
    if (shared >= 2) {
        const Vec3 n = shape_of(at(s[0]), at(s[1]), at(s[2])).normal, m = shape_of(at(t[0]), at(t[1]), at(t[2])).normal;
        return n.dot(m) < kFoldCosine;
    }
    const auto pierces = [&](const Triangle& x, const Triangle& y) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = x[k], b = x[(k + 1) % 3];
            if (!has(y, a) && !has(y, b) && cross_triangle(at(a), at(b), at(y[0]), at(y[1]), at(y[2]))) return true;
        }
        return false;
    };
    return pierces(s, t) || pierces(t, s);
}

bool similar(const Rgb8& a, const Rgb8& b, int step) {
    for (std::size_t k = 0; k < 3; ++k)
        if (std::abs(int{a[k]} - int{b[k]}) > step) return false;
    return true;
}

Rgb8 mean_color(const Rgb8& a, const Rgb8& b, const Rgb8& c) {
    Rgb8 mean;
    for (std::size_t k = 0; k < 3; ++k) mean[k] = static_cast<std::uint8_t>((int{a[k]} + int{b[k]} + int{c[k]}) / 3);
    return mean;
}

/// The vertices that went, filed under the triangle that now stands for them.
struct Samples {
    std::vector<std::uint32_t> first;  ///< per triangle
    std::vector<std::uint32_t> next;   ///< per vertex
    /// Per vertex: it could not go at the full tolerance, and nothing has changed around it since.
    std::vector<std::uint8_t> settled;
};

/// Work of one thread on one block.
class BlockSimplifier {
  public:
    BlockSimplifier(CollapseMesh& mesh, Samples& samples, const std::vector<std::uint32_t>& block,
                    const std::vector<std::uint8_t>& locked, const std::vector<Rgb8>& colors, int color_step)
        : mesh_(mesh), samples_(samples), block_(block), locked_(locked), colors_(colors), color_step_(color_step) {}

    void sweep(const std::uint32_t* begin, const std::uint32_t* end, double allowed, bool full) {
        for (const std::uint32_t* v = begin; v != end; ++v)
            if (locked_[*v] == 0 && mesh_.alive(*v) && samples_.settled[*v] == 0) try_vertex(*v, allowed, full);
    }

  private:
    void try_vertex(std::uint32_t u, double allowed, bool full) {
        mesh_.corners_around(u, around_);
        for (const Corner c : around_)
            if (block_[mesh_.vertex(CollapseMesh::next(c))] != block_[u]) return;
        old_.clear();
        for (const Corner c : around_) {
            const Triangle& t = mesh_.triangle(c / 3);
            old_.push_back(shape_of(mesh_.position(t[0]), mesh_.position(t[1]), mesh_.position(t[2])));
        }
        Corner best = kNone;
        double best_cost = std::numeric_limits<double>::infinity();
        for (const Corner c : around_) {
            const double cost = cost_of(u, c, allowed);
            if (cost < best_cost) {
                best_cost = cost;
                best = c;
            }
        }
        if (best == kNone || !mesh_.may_collapse(around_, best) || meets_neighbors(u, best) ||
            !file_samples(u, best, allowed)) {
            samples_.settled[u] = full ? 1 : 0;
            return;
        }
        for (const Corner c : around_) samples_.settled[mesh_.vertex(CollapseMesh::next(c))] = 0;
        mesh_.collapse(around_, best);
    }

    /// Infinite if the collapse is not allowed; else the distance of u from the new surface with a share for shape.
    [[nodiscard]] double cost_of(std::uint32_t u, Corner edge, double allowed) const {
        constexpr double never = std::numeric_limits<double>::infinity();
        const std::uint32_t v = mesh_.vertex(CollapseMesh::next(edge));
        if (!similar(colors_[u], colors_[v], color_step_)) return never;
        double nearest2 = never, worst = 1.0;
        for (std::size_t i = 0; i < around_.size(); ++i) {
            const std::uint32_t p = mesh_.vertex(CollapseMesh::next(around_[i]));
            const std::uint32_t q = mesh_.vertex(CollapseMesh::previous(around_[i]));
            if (p == v || q == v) continue;
            const Shape now = shape_of(mesh_.position(v), mesh_.position(p), mesh_.position(q));
            if (now.quality < kLeastQuality && now.quality < old_[i].quality) return never;
            if (now.normal.dot(old_[i].normal) < kTurnCosine && old_[i].quality > 1e-4) return never;
            if (!(now.quality > 1e-5)) return never;
            worst = std::min(worst, now.quality);
            const Vec3 on =
                closest_on_triangle(mesh_.position(u), mesh_.position(v), mesh_.position(p), mesh_.position(q));
            nearest2 = std::min(nearest2, (on - mesh_.position(u)).squaredNorm());
        }
        const double distance = std::sqrt(nearest2);
        return distance > allowed ? never : distance + 0.2 * allowed * (1.0 - worst);
    }

    /// Whether a triangle of the new ring passes through one that shares a vertex with the ring, or folds onto one it
    /// shares an edge with. Decided in floating point: most of what the exact check would find later.
    [[nodiscard]] bool meets_neighbors(std::uint32_t u, Corner edge) {
        const std::uint32_t v = mesh_.vertex(CollapseMesh::next(edge));
        collect_neighbors(u);
        for (const Corner c : around_) {
            const std::uint32_t p = mesh_.vertex(CollapseMesh::next(c)), q = mesh_.vertex(CollapseMesh::previous(c));
            if (p == v || q == v) continue;
            for (const std::uint32_t t : neighbors_)
                if (meet(mesh_, {v, p, q}, mesh_.triangle(t))) return true;
        }
        return folds_in_ring(v);
    }

    /// Triangles at the ring's vertices that are not part of the ring.
    void collect_neighbors(std::uint32_t u) {
        neighbors_.clear();
        for (const Corner c : around_) {
            mesh_.corners_around(mesh_.vertex(CollapseMesh::next(c)), fan_);
            for (const Corner d : fan_) {
                const Triangle& t = mesh_.triangle(d / 3);
                if (t[0] != u && t[1] != u && t[2] != u) neighbors_.push_back(d / 3);
            }
        }
        std::sort(neighbors_.begin(), neighbors_.end());
        neighbors_.erase(std::unique(neighbors_.begin(), neighbors_.end()), neighbors_.end());
    }

    /// Neighbouring triangles of the new fan that lie nearly face to face.
    [[nodiscard]] bool folds_in_ring(std::uint32_t v) const {
        const auto normal = [&](Corner c) {
            return shape_of(mesh_.position(v), mesh_.position(mesh_.vertex(CollapseMesh::next(c))),
                            mesh_.position(mesh_.vertex(CollapseMesh::previous(c))))
                .normal;
        };
        for (std::size_t i = 0; i < around_.size(); ++i)
            if (normal(around_[i]).dot(normal(around_[(i + 1) % around_.size()])) < kFoldCosine) return true;
        return false;
    }

    /// Finds for u and every sample of its ring the nearest triangle of the new ring. Changes nothing and returns false
    /// if one is farther than allowed.
    bool file_samples(std::uint32_t u, Corner edge, double allowed) {
        const std::uint32_t v = mesh_.vertex(CollapseMesh::next(edge));
        moved_.assign(1, {u, kNone, 0.0, {}});
        staying_.clear();
        for (const Corner c : around_) {
            for (std::uint32_t s = samples_.first[c / 3]; s != kNone; s = samples_.next[s])
                moved_.push_back({s, kNone, 0.0, {}});
            const std::uint32_t p = mesh_.vertex(CollapseMesh::next(c)), q = mesh_.vertex(CollapseMesh::previous(c));
            if (p != v && q != v) staying_.push_back({c / 3, p, q});
        }
        if (moved_.size() > kMostSamples) return false;
        for (Filed& sample : moved_) {
            const Vec3& at = mesh_.position(sample.vertex);
            double nearest2 = std::numeric_limits<double>::infinity();
            for (const Ring& r : staying_) {
                const Vec3 on = closest_on_triangle(at, mesh_.position(v), mesh_.position(r.p), mesh_.position(r.q));
                const double d2 = (on - at).squaredNorm();
                if (d2 >= nearest2) continue;
                nearest2 = d2;
                sample.triangle = r.triangle;
                sample.color = mean_color(colors_[v], colors_[r.p], colors_[r.q]);
            }
            sample.distance = std::sqrt(nearest2);
            if (sample.distance > allowed || !similar(sample.color, colors_[sample.vertex], color_step_)) return false;
        }
        for (const Corner c : around_) samples_.first[c / 3] = kNone;
        for (const Filed& sample : moved_) {
            samples_.next[sample.vertex] = samples_.first[sample.triangle];
            samples_.first[sample.triangle] = sample.vertex;
        }
        return true;
    }

    struct Filed {
        std::uint32_t vertex, triangle;
        double distance;
        Rgb8 color;  ///< of that triangle
    };
    struct Ring {
        std::uint32_t triangle, p, q;
    };

    CollapseMesh& mesh_;
    Samples& samples_;
    const std::vector<std::uint32_t>& block_;
    const std::vector<std::uint8_t>& locked_;
    const std::vector<Rgb8>& colors_;
    int color_step_;
    std::vector<Corner> around_, fan_;
    std::vector<std::uint32_t> neighbors_;
    std::vector<Shape> old_;
    std::vector<Filed> moved_;
    std::vector<Ring> staying_;
};

/// Cubes of one pass: the block of each vertex, and the vertices in order of blocks.
struct Blocks {
    std::vector<std::uint32_t> of_vertex;
    std::vector<std::uint32_t> order;
    std::vector<std::uint32_t> first;
};

Blocks make_blocks(const CollapseMesh& mesh, double side_mm, int pass) {
    const std::size_t n = mesh.vertex_count();
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    for (std::uint32_t v = 0; v < n; ++v) low = low.cwiseMin(mesh.position(v));
    // Thirds of a side: no seam of one pass lies on a seam of another.
    low -= Vec3::Constant(side_mm * pass / kPasses);
    std::vector<std::uint64_t> key(n);
    for (std::uint32_t v = 0; v < n; ++v) {
        const Vec3 c = (mesh.position(v) - low) / side_mm;
        key[v] = (static_cast<std::uint64_t>(c[2]) << 42) | (static_cast<std::uint64_t>(c[1]) << 21) |
                 static_cast<std::uint64_t>(c[0]);
    }
    Blocks blocks;
    for (std::uint32_t v = 0; v < n; ++v)
        if (mesh.alive(v)) blocks.order.push_back(v);
    std::sort(blocks.order.begin(), blocks.order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key[a] != key[b] ? key[a] < key[b] : a < b; });
    blocks.of_vertex.assign(n, kNone);
    for (std::uint32_t i = 0; i < blocks.order.size(); ++i) {
        if (i == 0 || key[blocks.order[i]] != key[blocks.order[i - 1]]) blocks.first.push_back(i);
        blocks.of_vertex[blocks.order[i]] = static_cast<std::uint32_t>(blocks.first.size() - 1);
    }
    blocks.first.push_back(static_cast<std::uint32_t>(blocks.order.size()));
    return blocks;
}

TriangleMesh collapse_all(const TriangleMesh& input, const std::vector<Rgb8>& colors,
                          const std::vector<std::uint8_t>& locked, const SimplifySettings& settings,
                          const RunControl& run) {
    CollapseMesh mesh(input);
    Samples samples{std::vector<std::uint32_t>(mesh.triangle_slots(), kNone),
                    std::vector<std::uint32_t>(mesh.vertex_count(), kNone),
                    {}};
    TriangleMesh result;
    double tolerance = settings.tolerance_mm;
    for (int doubling = 0; doubling < kDoublings; ++doubling) {
        samples.settled.assign(mesh.vertex_count(), 0);
        const int color_step = doubling == 0 ? settings.color_step : 255;
        for (int pass = 0; pass < kPasses; ++pass) {
            const Blocks blocks = make_blocks(mesh, settings.block_mm, pass);
            parallel_chunks(blocks.first.size() - 1, 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t b = begin; b < end; ++b) {
                    BlockSimplifier worker(mesh, samples, blocks.of_vertex, locked, colors, color_step);
                    for (const double share : kSweeps) {
                        run.throw_if_stopped();
                        worker.sweep(blocks.order.data() + blocks.first[b], blocks.order.data() + blocks.first[b + 1],
                                     share * tolerance, share == 1.0);
                    }
                }
            });
        }
        result = mesh.extract();
        if (settings.target_triangles == 0 || result.triangles.size() <= settings.target_triangles) break;
        tolerance *= 2.0;
    }
    return result;
}

/// Locks the input's vertices within `reach` of any triangle that meets another. False if there is none.
bool lock_meetings(const TriangleMesh& input, const TriangleMesh& result, double reach,
                   std::vector<std::uint8_t>& locked, const RunControl& run) {
    Eigen::AlignedBox3d none;
    std::vector<Eigen::AlignedBox3d> boxes;
    for (const auto& [a, b] : find_self_intersections(result, run)) {
        Eigen::AlignedBox3d box = none;
        for (const std::uint32_t t : {a, b})
            for (const std::uint32_t v : result.triangles[t]) box.extend(result.positions_mm[v]);
        boxes.emplace_back(box.min() - Vec3::Constant(reach), box.max() + Vec3::Constant(reach));
    }
    parallel_for(boxes.empty() ? 0 : input.positions_mm.size(), 4096, [&](std::size_t v) {
        for (const Eigen::AlignedBox3d& box : boxes)
            if (box.contains(input.positions_mm[v])) {
                locked[v] = 1;
                break;
            }
    });
    return !boxes.empty();
}

}  // namespace

TriangleMesh simplify(const TriangleMesh& mesh, const std::vector<Rgb8>& colors, const SimplifySettings& settings,
                      const RunControl& run) {
    std::vector<std::uint8_t> locked(mesh.positions_mm.size(), 0);
    for (int attempt = 0; attempt < kRepairs; ++attempt) {
        TriangleMesh result = collapse_all(mesh, colors, locked, settings, run);
        if (!lock_meetings(mesh, result, (2 << attempt) * settings.tolerance_mm, locked, run)) return result;
    }
    return mesh;
}

}  // namespace fretwork
