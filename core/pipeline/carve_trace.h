// What a run was like on its way: kept for reports only.
#pragma once

#include <string>
#include <vector>

#include "core/exemplar/image.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Stress of one pattern.
struct StressField {
    std::vector<float> voxel_mpa;     ///< one per surface voxel; negative where nothing is known, as in empty ones
    std::vector<double> samples_mpa;  ///< what figures and histograms are of, ascending
};

/// Stress before and after reinforcement, whatever analysis it comes from. Both are of the same loads and the same
/// material, so that they can be compared.
struct ShellStress {
    std::string name;                     ///< of the analysis, for a caption
    std::string sample_name;              ///< what a sample is, in the plural
    std::string before_name, after_name;  ///< what was looked at
    StressField before, after;
    double allowable_mpa = 0.0;
};

struct CarveTrace {
    SolidStates first_solid;         ///< of the first synthesis, before anything was connected or reinforced
    std::vector<Rgb8> first_colors;  ///< sRGB, one per voxel
    ShellStress stress;
};

/// Of samples in ascending order; zeros where there is none.
struct StressFigures {
    double average_mpa = 0.0;
    double median_mpa = 0.0;
    double p99_mpa = 0.0;  ///< the least value that 99 % of the samples do not exceed
    double max_mpa = 0.0;
};
StressFigures stress_figures(const std::vector<double>& samples_mpa);

}  // namespace fretwork
