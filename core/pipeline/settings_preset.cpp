#include "core/pipeline/settings_schema.h"

namespace fretwork {
namespace {

void apply_draft(Settings& s) {
    s.shell.resolution = 128;
    s.synthesis.search.candidates = 24;
    s.synthesis.search.coarse_passes = 4;
    s.structure.steps.samples = 500;
    s.structure.steps.max_iterations = 6;
    s.fabrication.simplify_voxels = 0.2;
}

void apply_fine(Settings& s) {
    s.shell.resolution = 512;
    s.synthesis.search.candidates = 64;
    s.synthesis.search.fine_random_candidates = 16;
    s.synthesis.search.coarse_passes = 16;
    s.fabrication.simplify_voxels = 0.05;
}

// Section 4.2 and 5.2 of the paper: 26 directions, 16 x 16 translations, 64 rotations, 128 candidates,
// one pass per level from label (0, 0), unweighted sums, gravity alone, 1000 samples.
void apply_paper(Settings& s) {
    s.synthesis.search.directions = 26;
    s.synthesis.search.rotations = 64;
    s.synthesis.search.translations = 16;
    s.synthesis.search.candidates = 128;
    s.synthesis.search.fine_random_candidates = 128;
    s.synthesis.search.transported = 0;
    s.synthesis.search.coarse_passes = 1;
    s.synthesis.search.random_start = false;
    s.synthesis.search.normalize_energy = false;
    s.synthesis.search.orientation_weight = 0.0;
    s.synthesis.search.border_weight = 0.0;
    s.synthesis.search.orientation_smoothing = 0.0;
    s.synthesis.search.count_repeated = true;
    s.synthesis.search.jitter_from_level = 0;
    s.structure.steps.rules = ReinforceRules::kPaper;
    s.structure.steps.samples = 1000;
}

}  // namespace

void apply_preset(Settings& settings, Preset preset) {
    settings.synthesis.preset = preset;
    switch (preset) {
        case Preset::kDraft:
            return apply_draft(settings);
        case Preset::kDefault:
            return;
        case Preset::kFine:
            return apply_fine(settings);
        case Preset::kPaper:
            return apply_paper(settings);
    }
}

}  // namespace fretwork
