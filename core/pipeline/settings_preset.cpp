#include "core/pipeline/settings_schema.h"
#include "core/synthesis/synthesis_presets.h"

namespace fretwork {

void apply_preset(Settings& settings, Preset preset) {
    settings.synthesis.preset = preset;
    switch (preset) {
        case Preset::kDraft:
            // The search stays that of the full run, whose coarse levels these are (shell.halvings).
            settings.structure.steps.samples = 250;
            settings.structure.steps.max_iterations = 2;
            settings.fabrication.simplify_voxels = 0.15;
            break;
        case Preset::kDefault:
            break;
        case Preset::kFine:
            settings.synthesis.search = synthesis_settings(SynthesisPreset::kFine);
            settings.shell.resolution = 512;
            settings.fabrication.simplify_voxels = 0.03;
            break;
        case Preset::kPaper:
            settings.synthesis.search = synthesis_settings(SynthesisPreset::kPaper);
            settings.structure.steps.rules = ReinforceRules::kPaper;
            break;
    }
}

}  // namespace fretwork
