#include "core/pipeline/strength_rounds.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "core/enlarge/widen_weak.h"
#include "core/pipeline/stage_plan.h"
#include "core/strength/strength_faults.h"

namespace fretwork {
namespace {

constexpr double kGain = 1.02;         // that counts as stronger
constexpr int kPatience = 2;           // rounds without it
constexpr double kShareOfRound = 0.3;  // of the progress that is left
constexpr double kShareOfCheck = 0.5;  // of a round

class Rounds {
  public:
    Rounds(const SurfaceVoxels& shell, const GeodesicLinks& links, const SurfaceLoads& loads,
           const StrengthRoundSettings& settings)
        : shell_(shell),
          links_(links),
          loads_(loads),
          settings_(settings),
          budget_left_(static_cast<std::size_t>(settings.budget * static_cast<double>(shell.size()))) {}

    StrengthRounds run(MadeObject object, const MakeObject& make, const RunControl& run) {
        OpenEndedSlices slices(run, kShareOfRound);
        for (int round = 0;; ++round) {
            const RunControl turn = slices.next();
            const ShellStrength found = look_at(object, turn.slice(0.0, kShareOfCheck));
            std::vector<VoxelIndex> added;
            result_.record.stopped_by = reason_to_stop(round);
            if (result_.record.stopped_by.empty()) added = strengthening(object, found, turn);
            std::vector<std::uint8_t> forced = object.forced;
            if (best_now_) result_.object = std::move(object);
            if (!result_.record.stopped_by.empty()) break;
            for (const VoxelIndex v : added) forced[v] = 1;
            object = make(std::move(forced), added, turn.slice(kShareOfCheck, 1.0));
        }
        result_.record.faults = strength_faults(result_.record.check.report);
        return std::move(result_);
    }

  private:
    ShellStrength look_at(const MadeObject& object, const RunControl& run) {
        StrengthCheck check = check_strength(object.carved.mesh, loads_, settings_.check, run);
        ShellStrength found = strength_on_shell(shell_, object.enlarged.solid, check, run);
        asked_ = check.report.safety_factor;
        const double least = check.report.least_factor;
        const auto weak = std::ranges::count_if(found.factor, [&](float factor) { return double{factor} < asked_; });
        std::vector<StrengthRound>& rounds = result_.record.rounds;
        rounds.push_back({least, static_cast<std::size_t>(weak), 0});
        stalled_ = rounds.size() > 1 && least < kGain * counted_ ? stalled_ + 1 : 0;
        if (rounds.size() == 1 || least >= kGain * counted_) counted_ = least;
        best_now_ = rounds.size() == 1 || least > best_;
        if (!best_now_) return found;
        best_ = least;
        if (rounds.size() == 1) result_.first = found;
        result_.on_shell = found;
        result_.record.check = std::move(check);
        keep_report_only(result_.record.check);
        return found;
    }

    [[nodiscard]] std::string reason_to_stop(int round) const {
        if (best_ >= asked_) return "holds";
        if (round >= settings_.rounds) return "rounds";
        if (stalled_ >= kPatience) return "no gain";
        return budget_left_ == 0 ? "budget" : "";
    }

    std::vector<VoxelIndex> strengthening(const MadeObject& object, const ShellStrength& found, const RunControl& run) {
        std::vector<float> gain(found.factor.size());
        for (std::size_t v = 0; v < gain.size(); ++v)
            gain[v] = static_cast<float>(asked_) / std::max(found.factor[v], 1e-6F);
        std::vector<VoxelIndex> added =
            widen_weak(shell_, links_, object.enlarged.solid, gain, {settings_.most_voxels, budget_left_}, run);
        if (added.empty()) result_.record.stopped_by = "nothing to fill";
        budget_left_ -= added.size();
        result_.record.rounds.back().voxels_added = added.size();
        return added;
    }

    const SurfaceVoxels& shell_;
    const GeodesicLinks& links_;
    const SurfaceLoads& loads_;
    const StrengthRoundSettings& settings_;
    std::size_t budget_left_;
    double asked_ = 0.0;
    double best_ = 0.0, counted_ = 0.0;  ///< least factors: of the best round, and of the last that gained
    int stalled_ = 0;
    bool best_now_ = false;
    StrengthRounds result_;
};

/// Of surface voxels with a wall below.
StressField field_of(const ShellStrength& strength) {
    StressField field;
    field.voxel_mpa = strength.stress_mpa;
    for (const float mpa : strength.stress_mpa)
        if (mpa >= 0.0F) field.samples_mpa.push_back(double{mpa});
    std::ranges::sort(field.samples_mpa);
    return field;
}

}  // namespace

ShellStress analyzed_stress(const StrengthRounds& rounds, const Material& material) {
    ShellStress stress;
    stress.name = "the full analysis of every voxel of the wall";
    stress.sample_name = "voxels of the surface, each with the worst of the wall below it";
    stress.before_name = "the object as the fast model had reinforced it";
    stress.after_name = "the object that came out";
    stress.before = field_of(rounds.first);
    stress.after = field_of(rounds.on_shell);
    stress.allowable_mpa = material.strength_z_mpa / rounds.record.check.report.safety_factor;
    return stress;
}

StrengthRounds strengthen(MadeObject object, const SurfaceVoxels& shell, const GeodesicLinks& links,
                          const SurfaceLoads& loads, const StrengthRoundSettings& settings, const MakeObject& make,
                          const RunControl& run) {
    return Rounds(shell, links, loads, settings).run(std::move(object), make, run);
}

}  // namespace fretwork
