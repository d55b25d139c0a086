#include "core/synthesis/resynthesize.h"

#include <algorithm>
#include <cstddef>

#include "core/synthesis/optimize.h"
#include "core/synthesis/passes.h"

namespace fretwork {
namespace {

void sort_unique(std::vector<VoxelIndex>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

struct PointSum {
    std::int64_t x = 0, y = 0, z = 0, count = 0;
};

std::int64_t squared_distance(const FixedPoint& p, const PointSum& sum) {
    const std::int64_t dx = p.x - sum.x / sum.count, dy = p.y - sum.y / sum.count, dz = p.z - sum.z / sum.count;
    return dx * dx + dy * dy + dz * dz;
}

/// Tags the voxels listed in `tagged`; each gets the most central of its forced points.
/// \param tagged  voxel of the level that each forced point lies below; repeats
ForcedSolid tag_level(std::size_t voxels, const std::vector<VoxelIndex>& tagged,
                      const std::vector<FixedPoint>& points) {
    ForcedSolid tags;
    tags.entry.assign(voxels, 0);
    std::vector<PointSum> sums;
    for (std::size_t i = 0; i < tagged.size(); ++i) {
        std::uint32_t& entry = tags.entry[tagged[i]];
        if (entry == 0) {
            sums.emplace_back();
            tags.probes.push_back(points[i]);
            entry = static_cast<std::uint32_t>(sums.size());
        }
        PointSum& s = sums[entry - 1];
        s = {s.x + points[i].x, s.y + points[i].y, s.z + points[i].z, s.count + 1};
    }
    for (std::size_t i = 0; i < tagged.size(); ++i) {
        const std::uint32_t entry = tags.entry[tagged[i]] - 1;
        FixedPoint& probe = tags.probes[entry];
        if (squared_distance(points[i], sums[entry]) < squared_distance(probe, sums[entry])) probe = points[i];
    }
    return tags;
}

/// Tags the forced voxels and all their parents. All forced points below a local voxel are local,
/// because the lists are whole subtrees.
std::vector<ForcedSolid> tag_parents(const SynthesisProblem& problem, const std::vector<std::uint8_t>& forced_solid,
                                     const LocalVoxels& local) {
    std::vector<VoxelIndex> tagged;
    std::vector<FixedPoint> points;
    for (const VoxelIndex v : local[0])
        if (forced_solid[v] != 0) {
            tagged.push_back(v);
            points.push_back(problem.levels[0].points[v]);
        }
    std::vector<ForcedSolid> tags;
    for (std::size_t l = 0; l < local.size(); ++l) {
        if (l > 0)
            for (VoxelIndex& v : tagged) v = problem.levels[l - 1].shell->parent[v];
        tags.push_back(tag_level(problem.levels[l].size(), tagged, points));
    }
    return tags;
}

/// The choices of the local voxels as they were, to go back to when the update is stopped.
class Restore {
  public:
    Restore(const LocalVoxels& local, std::vector<Choices>& all) : local_(local), all_(all) {
        for (std::size_t l = 0; l < local.size(); ++l)
            for (const VoxelIndex v : local[l]) saved_.push_back(all[l][v]);
    }
    ~Restore() {
        if (kept_) return;
        std::size_t i = 0;
        for (std::size_t l = 0; l < local_.size(); ++l)
            for (const VoxelIndex v : local_[l]) all_[l][v] = saved_[i++];
    }
    Restore(const Restore&) = delete;
    Restore& operator=(const Restore&) = delete;

    void keep_changes() { kept_ = true; }

  private:
    const LocalVoxels& local_;
    std::vector<Choices>& all_;
    std::vector<Choice> saved_;
    bool kept_ = false;
};

/// Children of voxels whose label changed take over the new one.
void upsample_changed(const SynthesisProblem& problem, std::size_t l, const std::vector<VoxelIndex>& changed_parents,
                      std::vector<Choices>& all) {
    const ProblemLevel& level = problem.levels[l];
    const PyramidLevel& parents = *problem.levels[l + 1].shell;
    for (const VoxelIndex parent : changed_parents)
        for (std::uint32_t i = parents.first_child[parent]; i < parents.first_child[parent + 1]; ++i) {
            const VoxelIndex child = parents.children[i];
            const Choice& from = all[l + 1][parent];
            all[l][child] = problem.make_choice(level, from.label, from.part, level.points[child]);
        }
}

}  // namespace

LocalVoxels voxels_around(const SynthesisProblem& problem, const std::vector<VoxelIndex>& changed, int coarsest) {
    const auto top = static_cast<std::size_t>(coarsest);
    LocalVoxels local(top + 1);
    local[top] = changed;
    for (std::size_t l = 0; l < top; ++l)
        for (VoxelIndex& v : local[top]) v = problem.levels[l].shell->parent[v];
    sort_unique(local[top]);
    for (std::size_t l = top; l-- > 0;) {
        const PyramidLevel& parents = *problem.levels[l + 1].shell;
        for (const VoxelIndex p : local[l + 1])
            local[l].insert(local[l].end(), parents.children.begin() + parents.first_child[p],
                            parents.children.begin() + parents.first_child[p + 1]);
        std::sort(local[l].begin(), local[l].end());
    }
    return local;
}

std::vector<VoxelIndex> update_locally(const SynthesisProblem& problem, const std::vector<std::uint8_t>& forced_solid,
                                       const LocalVoxels& local, std::uint32_t epoch, std::vector<Choices>& all,
                                       const RunControl& run) {
    const std::vector<ForcedSolid> tags = tag_parents(problem, forced_solid, local);
    Restore restore(local, all);
    std::vector<Label> original;
    for (const VoxelIndex v : local[0]) original.push_back(all[0][v].label);

    std::vector<VoxelIndex> changed;
    for (std::size_t l = local.size(); l-- > 0;) {
        const ProblemLevel& level = problem.levels[l];
        std::vector<Label> before;
        for (const VoxelIndex v : local[l]) before.push_back(all[l][v].label);
        if (l + 1 < local.size()) upsample_changed(problem, l, changed, all);
        const Subpasses subpasses = split_into_subpasses(level.shell->coords, local[l]);
        const int passes = std::max(kLocalPasses, passes_on_level(problem.settings, level.rank));
        for (int pass = 0; pass < passes; ++pass)
            optimize_pass(problem, level, subpasses, tags[l], epoch_of(level.height, pass, epoch), all[l], run);
        changed.clear();
        for (std::size_t i = 0; i < local[l].size(); ++i)
            if (all[l][local[l][i]].label != before[i]) changed.push_back(local[l][i]);
    }
    changed.clear();
    for (std::size_t i = 0; i < local[0].size(); ++i)
        if (all[0][local[0][i]].label != original[i]) changed.push_back(local[0][i]);
    restore.keep_changes();
    return changed;
}

}  // namespace fretwork
