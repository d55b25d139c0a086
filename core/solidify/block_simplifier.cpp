#include "core/solidify/block_simplifier.h"

namespace fretwork {
namespace {

using Corner = CollapseMesh::Corner;
constexpr std::uint32_t kNone = CollapseMesh::kNone;

/// A triangle may turn by up to 60 degrees in one collapse, and must stay this good. One that was worse before may
/// stay as bad.
constexpr double kTurnCosine = 0.5;
constexpr double kLeastQuality = 0.03;

/// Two neighbouring triangles closer to face to face than this are as good as folded over.
constexpr double kFoldCosine = -0.95;

/// A neighbour this many tolerances off the planes around a vertex cannot take its place within the tolerance.
constexpr double kFarthest = 4.0;

/// Ways to go that are tried for one vertex.
constexpr std::size_t kMostTries = 2;

/// More samples than this in one ring would cost more than the triangles it saves.
constexpr std::size_t kMostSamples = 1000;

bool has(const Triangle& t, std::uint32_t v) {
    return t[0] == v || t[1] == v || t[2] == v;
}

}  // namespace

void BlockSimplifier::sweep(std::span<const std::uint32_t> vertices, double allowed, bool full) {
    for (const std::uint32_t u : vertices) {
        if (state_.locked[u] != 0 || state_.settled[u] != 0 || !mesh_.alive(u)) continue;
        if (!gather_spokes(u)) continue;
        if (!try_vertex(u, allowed)) state_.settled[u] = full ? 1 : 0;
    }
}

/// False if u has a neighbour in another block.
bool BlockSimplifier::gather_spokes(std::uint32_t u) {
    mesh_.corners_around(u, around_);
    spokes_.clear();
    const Vec3& at = mesh_.position(u);
    for (const Corner c : around_) {
        const std::uint32_t v = mesh_.vertex(CollapseMesh::next(c));
        if (block_[v] != block_[u]) return false;
        spokes_.push_back({c, v, mesh_.position(v) - at, state_.shape[c / 3]});
    }
    return true;
}

bool BlockSimplifier::try_vertex(std::uint32_t u, double allowed) {
    rank_candidates(allowed);
    for (std::size_t k = 0; k < candidates_.size() && k < kMostTries; ++k)
        if (try_candidate(u, candidates_[k], allowed)) return true;
    return false;
}

std::uint8_t BlockSimplifier::area(std::size_t spoke) const {
    return state_.areas.of_triangle[spokes_[spoke].corner / 3];
}

/// The edges at u that are borders between areas: how many, and the first two.
std::size_t BlockSimplifier::find_border() {
    std::size_t count = 0;
    for (std::size_t i = 0; i < spokes_.size(); ++i) {
        if (area(i) == area(i > 0 ? i - 1 : spokes_.size() - 1)) continue;
        if (count < 2) border_spokes_[count] = i;
        ++count;
    }
    return count;
}

/// A vertex of a border goes along it only, to where the border runs nearly straight past it; one where three areas
/// meet stays.
bool BlockSimplifier::keeps_border(std::size_t toward, std::size_t borders) const {
    if (borders == 0) return true;
    if (borders != 2 || (toward != border_spokes_[0] && toward != border_spokes_[1])) return false;
    const Vec3 on =
        closest_on_segment<Vec3>(Vec3::Zero(), spokes_[border_spokes_[0]].offset, spokes_[border_spokes_[1]].offset);
    return on.squaredNorm() <= border_mm_ * border_mm_;
}

bool BlockSimplifier::stands_for(std::uint32_t triangle, std::uint32_t sample) const {
    const std::uint8_t own = state_.areas.of_vertex[sample];
    return !minds_areas() || own == MeshAreas::kBorder || own == state_.areas.of_triangle[triangle];
}

/// Cost of a way: how far its end lies off the planes around u, and a share for the shape of what comes out.
void BlockSimplifier::rank_candidates(double allowed) {
    candidates_.clear();
    const std::size_t borders = minds_areas() ? find_border() : 0;
    for (std::size_t i = 0; i < spokes_.size(); ++i) {
        if (!keeps_border(i, borders)) continue;
        double off = 0.0;
        for (const Spoke& s : spokes_)
            if (s.shape.quality > 1e-3F)
                off = std::max(off, std::abs(s.shape.normal.cast<double>().dot(spokes_[i].offset)));
        double worst = 1.0;
        if (off > kFarthest * allowed || !good_shape(i, worst)) continue;
        candidates_.push_back({i, off + 0.2 * allowed * (1.0 - worst)});
    }
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
        return a.cost != b.cost ? a.cost < b.cost : a.spoke < b.spoke;
    });
}

bool BlockSimplifier::good_shape(std::size_t toward, double& worst) const {
    const std::size_t n = spokes_.size();
    const Vec3& v = spokes_[toward].offset;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t j = i + 1 < n ? i + 1 : 0;
        if (i == toward || j == toward) continue;
        const Vec3 a = spokes_[i].offset - v, b = spokes_[j].offset - v;
        const Vec3 m = a.cross(b);
        const double length = m.norm();
        const double sides = a.squaredNorm() + b.squaredNorm() + (b - a).squaredNorm();
        const double quality = 2.0 * std::sqrt(3.0) * length / sides;
        const TriangleShape& before = spokes_[i].shape;
        if (!(quality > 1e-5)) return false;
        if (quality < kLeastQuality && quality < static_cast<double>(before.quality)) return false;
        if (before.quality > 1e-4F && m.dot(before.normal.cast<double>()) < kTurnCosine * length) return false;
        worst = std::min(worst, quality);
    }
    return true;
}

bool BlockSimplifier::try_candidate(std::uint32_t u, const Candidate& candidate, double allowed) {
    const Spoke& spoke = spokes_[candidate.spoke];
    if (!mesh_.may_collapse(around_, spoke.corner)) return false;
    make_ring(candidate.spoke);
    if (!find_samples(u, spoke.vertex, allowed) || meets_neighbors(u, spoke.vertex)) return false;
    commit(candidate.spoke);
    return true;
}

void BlockSimplifier::make_ring(std::size_t toward) {
    ring_.clear();
    const std::size_t n = spokes_.size();
    for (std::size_t k = 1; k + 1 < n; ++k) {
        const std::size_t i = (toward + k) % n, j = (i + 1) % n;
        const Vec3 a = spokes_[i].offset - spokes_[toward].offset, b = spokes_[j].offset - spokes_[toward].offset;
        const std::uint32_t p = spokes_[i].vertex, q = spokes_[j].vertex;
        const Vec3 normal = a.cross(b).normalized();
        ring_.push_back({spokes_[i].corner / 3, p, q, normal, normal.cross(a), normal.cross(b - a), normal.cross(-b)});
    }
}

/// Finds for u and every sample of its ring a triangle of the new ring that stands for it: the one it lies over, or
/// else the nearest. False if one is farther than allowed or of another area.
bool BlockSimplifier::find_samples(std::uint32_t u, std::uint32_t v, double allowed) {
    filed_.clear();
    const Vec3& at = mesh_.position(v);
    if (!file_sample(u, at, allowed)) return false;
    for (const Spoke& s : spokes_)
        for (std::uint32_t k = state_.first_sample[s.corner / 3]; k != kNone; k = state_.next_sample[k])
            if (filed_.size() >= kMostSamples || !file_sample(k, at, allowed)) return false;
    return true;
}

bool BlockSimplifier::file_sample(std::uint32_t sample, const Vec3& v, double allowed) {
    const Vec3& at = mesh_.position(sample);
    const Vec3 d = at - v;
    for (const NewTriangle& t : ring_) {
        if (std::abs(t.normal.dot(d)) > allowed || t.edge_v.dot(d) < 0.0 || t.edge_q.dot(d) < 0.0 ||
            t.edge_p.dot(at - mesh_.position(t.p)) < 0.0)
            continue;
        if (!stands_for(t.triangle, sample)) return false;
        filed_.push_back({sample, t.triangle});
        return true;
    }
    double nearest2 = std::numeric_limits<double>::infinity();
    const NewTriangle* nearest = nullptr;
    for (const NewTriangle& t : ring_) {
        const Vec3 on = closest_on_triangle(at, v, mesh_.position(t.p), mesh_.position(t.q));
        const double d2 = (on - at).squaredNorm();
        if (d2 >= nearest2) continue;
        nearest2 = d2;
        nearest = &t;
    }
    if (nearest2 > allowed * allowed || !stands_for(nearest->triangle, sample)) return false;
    filed_.push_back({sample, nearest->triangle});
    return true;
}

/// Calls `visit` for the triangles at the ring's vertices that are not part of the ring; often more than once.
template <class Visit>
void BlockSimplifier::for_each_neighbor(std::uint32_t u, const Visit& visit) const {
    for (const Spoke& s : spokes_) {
        // From beyond one side of the ring round the vertex to beyond the other.
        const Corner start = CollapseMesh::next(s.corner);
        for (Corner c = mesh_.turned(start); c != start; c = mesh_.turned(c))
            if (!has(mesh_.triangle(c / 3), u)) visit(c / 3);
    }
}

/// Whether a triangle of the new ring passes through one that shares a vertex with the ring, or folds onto one it
/// shares an edge with. Decided in floating point: most of what the exact check would find later.
bool BlockSimplifier::meets_neighbors(std::uint32_t u, std::uint32_t v) {
    if (clearly_apart(u)) return false;
    for (std::size_t i = 0; i + 1 < ring_.size(); ++i)
        if (ring_[i].normal.dot(ring_[i + 1].normal) < kFoldCosine) return true;
    neighbors_.clear();
    for_each_neighbor(u, [&](std::uint32_t t) { neighbors_.push_back(t); });
    std::sort(neighbors_.begin(), neighbors_.end());
    neighbors_.erase(std::unique(neighbors_.begin(), neighbors_.end()), neighbors_.end());
    for (const NewTriangle& s : ring_)
        for (const std::uint32_t t : neighbors_)
            if (meet(s, v, t)) return true;
    return false;
}

/// Seen along one direction the ring and all its neighbours face the viewer: the new ring then covers what the old one
/// covered, and no neighbour lies there.
bool BlockSimplifier::clearly_apart(std::uint32_t u) const {
    Vec3 sum = Vec3::Zero();
    for (const NewTriangle& t : ring_) sum += t.normal;
    const Vec3 view = sum.normalized();
    for (const NewTriangle& t : ring_)
        if (!(t.normal.dot(view) > 0.5)) return false;
    for (const Spoke& s : spokes_)
        if (!(s.shape.normal.cast<double>().dot(view) > 0.2)) return false;
    bool apart = true;
    const Vec3f view_f = view.cast<float>();
    for_each_neighbor(u, [&](std::uint32_t t) { apart = apart && state_.shape[t].normal.dot(view_f) > 0.2F; });
    return apart;
}

bool BlockSimplifier::meet(const NewTriangle& s, std::uint32_t v, std::uint32_t t) const {
    const Triangle& other = mesh_.triangle(t);
    const Triangle own = {v, s.p, s.q};
    const Vec3 normal_t = state_.shape[t].normal.cast<double>();
    int shared = 0;
    for (const std::uint32_t w : own) shared += has(other, w) ? 1 : 0;
    if (shared >= 2) return s.normal.dot(normal_t) < kFoldCosine;
    const auto at = [&](std::uint32_t w) -> const Vec3& { return mesh_.position(w); };
    // All corners that are not shared on one side of the other's plane.
    const auto beside = [&](const Triangle& x, const Vec3& normal, const Triangle& y) {
        bool above = true, below = true;
        for (const std::uint32_t w : y) {
            if (has(x, w)) continue;
            const double height = normal.dot(at(w) - at(x[0]));
            above = above && height > 0.0;
            below = below && height < 0.0;
        }
        return above || below;
    };
    if (beside(own, s.normal, other) || beside(other, normal_t, own)) return false;
    const auto pierces = [&](const Triangle& x, const Triangle& y) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = x[k], b = x[(k + 1) % 3];
            if (!has(y, a) && !has(y, b) && cross_triangle(at(a), at(b), at(y[0]), at(y[1]), at(y[2]))) return true;
        }
        return false;
    };
    return pierces(own, other) || pierces(other, own);
}

void BlockSimplifier::commit(std::size_t toward) {
    for (const Spoke& s : spokes_) {
        state_.settled[s.vertex] = 0;
        state_.first_sample[s.corner / 3] = kNone;
    }
    for (const Filed& sample : filed_) state_.file(sample.vertex, sample.triangle);
    const Corner edge = spokes_[toward].corner;
    log_.push_back(edge);
    log_.push_back(static_cast<Corner>(ring_.size()));
    for (std::size_t k = 1; k <= ring_.size(); ++k) log_.push_back(spokes_[(toward + k) % spokes_.size()].corner);
    mesh_.collapse(around_, edge);
    for (const NewTriangle& t : ring_) state_.measure(t.triangle);
}

}  // namespace fretwork
