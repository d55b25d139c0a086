#include "core/synthesis/synthesis_presets.h"

namespace fretwork {
namespace {

SynthesisSettings fine_settings() {
    SynthesisSettings s;
    s.directions = 600;
    s.candidates = 96;
    s.fine_random_candidates = 48;
    s.transported = 8;
    s.coarse_passes = 16;
    return s;
}

SynthesisSettings paper_settings() {
    SynthesisSettings s;
    s.directions = 26;
    s.rotations = 64;
    s.translations = 16;
    s.candidates = 128;
    s.fine_random_candidates = 128;
    s.transported = 0;
    s.count_repeated = true;
    s.orientation_smoothing = 0.0;
    s.orientation_weight = 0.0;
    s.normalize_energy = false;
    s.random_start = false;
    s.coarse_passes = 1;
    s.jitter_from_level = 0;
    s.start_level = 64;  // the coarsest level there is
    return s;
}

}  // namespace

SynthesisSettings synthesis_settings(SynthesisPreset preset) {
    switch (preset) {
        case SynthesisPreset::kFine:
            return fine_settings();
        case SynthesisPreset::kPaper:
            return paper_settings();
        case SynthesisPreset::kDefault:
            break;
    }
    return {};
}

}  // namespace fretwork
