// Closed pieces face outward, hollows inward.
#include <algorithm>
#include <map>
#include <utility>

#include "core/mesh/closest_point.h"
#include "core/mesh/components.h"
#include "core/mesh/repair_steps.h"
#include "core/mesh/triangle_math.h"

namespace fretwork::repair {
namespace {

struct Piece {
    Vec3 min_mm = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 max_mm = -min_mm;
    double volume_mm3 = 0.0;
    bool closed = true;
    std::vector<std::uint32_t> triangles;
    std::uint32_t outermost = 0;  ///< the piece that holds it and is held by none; itself where there is none
};

std::vector<Piece> measure_pieces(const TriangleMesh& mesh, const MeshComponents& components, const EdgeTable& edges,
                                  RepairCounts& counts, const RunControl& run) {
    std::vector<Piece> pieces(components.count);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (t % kOften == 0) run.throw_if_stopped();
        Piece& piece = pieces[components.of_triangle[t]];
        const Triangle& corners = mesh.triangles[t];
        piece.triangles.push_back(t);
        const Vec3 origin = mesh.positions_mm[mesh.triangles[piece.triangles[0]][0]];
        for (const std::uint32_t v : corners) {
            piece.min_mm = piece.min_mm.cwiseMin(mesh.positions_mm[v]);
            piece.max_mm = piece.max_mm.cwiseMax(mesh.positions_mm[v]);
        }
        piece.volume_mm3 +=
            (mesh.positions_mm[corners[0]] - origin)
                .dot((mesh.positions_mm[corners[1]] - origin).cross(mesh.positions_mm[corners[2]] - origin)) /
            6.0;
    }
    for (std::size_t e = 0; e < edges.size(); ++e)
        if (edges.half_edges(e).size() == 1) {
            pieces[components.of_triangle[edges.half_edges(e)[0] / 3]].closed = false;
            ++counts.border_edges;
        }
    counts.components = components.count;
    for (const Piece& piece : pieces) counts.open_components += piece.closed ? 0 : 1;
    return pieces;
}

bool box_holds(const Piece& outer, const Piece& inner) {
    return (outer.min_mm.array() <= inner.min_mm.array()).all() && (outer.max_mm.array() >= inner.max_mm.array()).all();
}

/// Which closed pieces hold which, by rays from a few triangles each; most of the rays decide.
class Nesting {
  public:
    Nesting(const TriangleMesh& mesh, const MeshComponents& components, const std::vector<Piece>& pieces,
            const RunControl& run)
        : mesh_(mesh), components_(components), pieces_(pieces), tree_(mesh, run) {
        Vec3 low = pieces[0].min_mm, high = pieces[0].max_mm;
        for (const Piece& piece : pieces) low = low.cwiseMin(piece.min_mm), high = high.cwiseMax(piece.max_mm);
        beyond_ = 1.5 * (high - low).norm() * Vec3(0.3183098862, 0.8414709848, 0.4342944819).normalized();
    }

    /// Pieces that hold piece `i`, ascending.
    [[nodiscard]] std::vector<std::uint32_t> holders(std::uint32_t i) const {
        constexpr std::size_t kRays = 5;
        const std::vector<std::uint32_t>& own = pieces_[i].triangles;
        std::vector<SegmentHit> hits;
        std::map<std::uint32_t, int> winding, rays_inside;
        for (std::size_t ray = 0; ray < kRays; ++ray) {
            const Triangle& t = mesh_.triangles[own[ray * (own.size() - 1) / (kRays - 1)]];
            const Vec3 from = (mesh_.positions_mm[t[0]] + mesh_.positions_mm[t[1]] + mesh_.positions_mm[t[2]]) / 3.0;
            tree_.all_hits(from, from + beyond_, hits);
            winding.clear();
            for (const SegmentHit& hit : hits) winding[components_.of_triangle[hit.triangle]] += hit.leaving ? 1 : -1;
            for (const auto& [piece, turns] : winding) rays_inside[piece] += turns != 0 ? 1 : 0;
        }
        std::vector<std::uint32_t> found;
        for (const auto& [j, rays] : rays_inside)
            if (j != i && pieces_[j].closed && rays > int{kRays} / 2 && box_holds(pieces_[j], pieces_[i]))
                found.push_back(j);
        return found;
    }

  private:
    const TriangleMesh& mesh_;
    const MeshComponents& components_;
    const std::vector<Piece>& pieces_;
    SurfaceTree tree_;
    Vec3 beyond_;
};

void find_outermost(const TriangleMesh& mesh, const MeshComponents& components, std::vector<Piece>& pieces,
                    const RunControl& run) {
    for (std::uint32_t i = 0; i < pieces.size(); ++i) pieces[i].outermost = i;
    if (std::count_if(pieces.begin(), pieces.end(), [](const Piece& p) { return p.closed; }) < 2) return;
    const Nesting nesting(mesh, components, pieces, run);
    std::vector<std::vector<std::uint32_t>> holders(pieces.size());
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
        if (i % 256 == 0) run.throw_if_stopped();
        if (pieces[i].closed) holders[i] = nesting.holders(i);
    }
    for (std::uint32_t i = 0; i < pieces.size(); ++i)
        for (const std::uint32_t j : holders[i])
            if (holders[j].empty()) {
                pieces[i].outermost = j;
                break;
            }
}

}  // namespace

void turn_outward(Draft& draft, const EdgeTable& edges) {
    const MeshComponents components = find_components(draft.mesh, edges);
    std::vector<Piece> pieces = measure_pieces(draft.mesh, components, edges, draft.counts, draft.run);
    find_outermost(draft.mesh, components, pieces, draft.run);
    for (const Piece& piece : pieces) {
        if (!piece.closed || !(pieces[piece.outermost].volume_mm3 < 0.0)) continue;
        ++draft.counts.inverted_components;
        for (const std::uint32_t t : piece.triangles) std::swap(draft.mesh.triangles[t][1], draft.mesh.triangles[t][2]);
    }
}

}  // namespace fretwork::repair
