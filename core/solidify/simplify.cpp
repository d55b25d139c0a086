#include "core/solidify/simplify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/mesh/self_intersections.h"
#include "core/solidify/block_simplifier.h"
#include "core/solidify/collapse_log.h"

namespace fretwork {
namespace {

/// Shares of the tolerance that the sweeps of a pass allow, so that what costs nothing goes first.
constexpr std::array<double, 4> kSweeps = {0.15, 0.5, 1.0, 1.0};
constexpr int kPasses = 3;
constexpr int kDoublings = 7;

/// Collapses taken back per triangle that meets another, doubled each round; all of them after the last.
constexpr int kRepairs = 10;

/// Cubes of one pass: the block of each vertex, and the vertices in order of blocks.
struct Blocks {
    std::vector<std::uint32_t> of_vertex;
    std::vector<std::uint32_t> order;
    std::vector<std::uint32_t> first;
};

Blocks make_blocks(const CollapseMesh& mesh, double side_mm, int pass) {
    const std::size_t n = mesh.vertex_count();
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (std::uint32_t v = 0; v < n; ++v) {
        low = low.cwiseMin(mesh.position(v));
        high = high.cwiseMax(mesh.position(v));
    }
    // Thirds of a side: no seam of one pass lies on a seam of another.
    low -= Vec3::Constant(side_mm * pass / kPasses);
    // So large a part that their number stays below that of the vertices.
    const Vec3 extent = ((high - low) / side_mm).array().floor() + 1.0;
    const double scale = std::max(1.0, std::cbrt(extent.prod() / static_cast<double>(n + 64)));
    std::array<std::uint32_t, 3> cells{};
    for (int k = 0; k < 3; ++k) cells[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(extent[k] / scale) + 1;
    Blocks blocks;
    blocks.of_vertex.resize(n);
    parallel_for(n, 1 << 15, [&](std::size_t v) {
        const Vec3 c = (mesh.position(static_cast<std::uint32_t>(v)) - low) / (side_mm * scale);
        const auto part = [&](int k) { return static_cast<std::uint32_t>(c[k]); };
        blocks.of_vertex[v] = (part(2) * cells[1] + part(1)) * cells[0] + part(0);
    });
    blocks.first.assign(std::size_t{cells[0]} * cells[1] * cells[2] + 1, 0);
    for (std::uint32_t v = 0; v < n; ++v)
        if (mesh.alive(v)) ++blocks.first[blocks.of_vertex[v] + 1];
    for (std::size_t b = 0; b + 1 < blocks.first.size(); ++b) blocks.first[b + 1] += blocks.first[b];
    blocks.order.resize(blocks.first.back());
    std::vector<std::uint32_t> end(blocks.first.begin(), blocks.first.end() - 1);
    for (std::uint32_t v = 0; v < n; ++v)
        if (mesh.alive(v)) blocks.order[end[blocks.of_vertex[v]]++] = v;
    return blocks;
}

class Simplifier {
  public:
    Simplifier(const TriangleMesh& input, const MeshAreas& areas, const SimplifySettings& settings,
               const RunControl& run)
        : settings_(settings), run_(run), state_(input, areas), log_(state_) {
        state_.shape.resize(input.triangles.size());
        parallel_for(input.triangles.size(), 1 << 14,
                     [&](std::size_t t) { state_.measure(static_cast<std::uint32_t>(t)); });
    }

    SimplifiedMesh run() {
        double tolerance = settings_.tolerance_mm;
        for (int doubling = 0; doubling < kDoublings; ++doubling, tolerance *= 2.0) {
            std::fill(state_.settled.begin(), state_.settled.end(), std::uint8_t{0});
            for (int pass = 0; pass < kPasses; ++pass)
                run_pass(pass, tolerance,
                         doubling == 0 ? settings_.border_mm : std::numeric_limits<double>::infinity());
            repair();
            if (settings_.target_triangles == 0 || alive_.size() <= settings_.target_triangles) break;
        }
        return extract();
    }

  private:
    [[nodiscard]] SimplifiedMesh extract() const {
        const CollapseMesh& mesh = state_.mesh;
        SimplifiedMesh result;
        std::vector<std::uint32_t> number(mesh.vertex_count());
        for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
            if (!mesh.alive(v)) continue;
            number[v] = static_cast<std::uint32_t>(result.vertex.size());
            result.vertex.push_back(v);
            result.mesh.positions_mm.push_back(mesh.position(v));
        }
        for (const std::uint32_t t : alive_) {
            const Triangle& k = mesh.triangle(t);
            result.mesh.triangles.push_back({number[k[0]], number[k[1]], number[k[2]]});
        }
        result.triangle = alive_;
        result.sound = sound_;
        return result;
    }

    void run_pass(int pass, double tolerance, double border_mm) {
        const Blocks blocks = make_blocks(state_.mesh, settings_.block_mm, pass);
        std::vector<std::vector<CollapseMesh::Corner>> logs(blocks.first.size() - 1);
        parallel_chunks(logs.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t b = begin; b < end; ++b) {
                const std::span<const std::uint32_t> vertices(blocks.order.data() + blocks.first[b],
                                                              blocks.order.data() + blocks.first[b + 1]);
                if (vertices.empty()) continue;
                BlockSimplifier worker(state_, blocks.of_vertex, border_mm, logs[b]);
                for (const double share : kSweeps) {
                    run_.throw_if_stopped();
                    worker.sweep(vertices, share * tolerance, share == 1.0);
                }
            }
        });
        for (std::vector<CollapseMesh::Corner>& part : logs) log_.append(std::move(part));
    }

    void list_alive() {
        alive_.clear();
        for (std::uint32_t t = 0; t < state_.mesh.triangle_slots(); ++t)
            if (state_.mesh.triangle_alive(t)) alive_.push_back(t);
    }

    /// Looks for triangles that meet, and takes back what was done last around them, then looks again where that
    /// changed something. At worst the mesh is as it came.
    void repair() {
        list_alive();
        std::vector<std::uint32_t> changed = alive_;
        for (int round = 0; !changed.empty(); ++round) {
            run_.throw_if_stopped();
            const std::vector<std::uint32_t> meeting = meeting_triangles(changed);
            sound_ = meeting.empty();
            if (sound_) return;
            changed = log_.take_back(meeting, round < kRepairs ? 1 << round : std::numeric_limits<int>::max());
            if (changed.empty()) return;
            list_alive();
            for (const std::uint32_t t : meeting)
                if (state_.mesh.triangle_alive(t)) changed.push_back(t);
            std::sort(changed.begin(), changed.end());
            changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
        }
    }

    /// Triangles that meet one of `changed`, and those.
    [[nodiscard]] std::vector<std::uint32_t> meeting_triangles(const std::vector<std::uint32_t>& changed) const {
        TriangleMesh now;
        now.positions_mm = state_.mesh.positions();
        now.triangles.reserve(alive_.size());
        std::vector<std::uint32_t> among;
        std::size_t next = 0;
        for (std::uint32_t i = 0; i < alive_.size(); ++i) {
            now.triangles.push_back(state_.mesh.triangle(alive_[i]));
            while (next < changed.size() && changed[next] < alive_[i]) ++next;
            if (next < changed.size() && changed[next] == alive_[i]) among.push_back(i);
        }
        std::vector<std::uint32_t> meeting;
        for (const auto& [a, b] : find_self_intersections_among(now, among, run_)) {
            meeting.push_back(alive_[a]);
            meeting.push_back(alive_[b]);
        }
        std::sort(meeting.begin(), meeting.end());
        meeting.erase(std::unique(meeting.begin(), meeting.end()), meeting.end());
        return meeting;
    }

    const SimplifySettings& settings_;
    const RunControl& run_;
    SimplifyState state_;
    CollapseLog log_;
    std::vector<std::uint32_t> alive_;  ///< triangles, ascending
    bool sound_ = true;
};

}  // namespace

SimplifiedMesh simplify(const TriangleMesh& mesh, const MeshAreas& areas, const SimplifySettings& settings,
                        const RunControl& run) {
    return Simplifier(mesh, areas, settings, run).run();
}

}  // namespace fretwork
