// How alike an output and its exemplar are. All figures: 0 = as alike as can be.
//
// Patch similarity after Simakov et al. 2008: d(q, p) is the sum of squared differences of two windows of 7 x 7 pixels
// of colour and solid, z_l its mean over random pairs of windows of the exemplar on level l (halved l times), and
//   completeness = mean_l mean_q min_p d(q, p) / z_l      q in the exemplar, p in the output
//   coherence    = mean_l mean_p min_q d(p, q) / z_l
// Windows of the exemplar are taken at half-pixel steps, since an output shows it at any phase.
// Patch measures alone reward verbatim copies and collapse: read them with coverage and the shapes.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "likeness/pattern_picture.h"
#include "likeness/windows.h"

namespace fretwork::likeness {

struct Likeness {
    double completeness = 0.0;
    double coherence = 0.0;
    /// Mean of the worst 5 % of min_q d(p, q) / z_0: cut features and seams, which means hide.
    double worst_seam = 0.0;
    /// Jensen-Shannon divergence, in bits, between where the nearest windows lie in the exemplar (4 x 4 cells) and even
    /// use: missing content, collapse. An alarm, not a ranking: patterns that repeat within the exemplar have it too.
    double coverage = 0.0;
    double solid_difference = 0.0;  ///< |solid fraction - that of the exemplar|
    double chords = 0.0;     ///< relative Wasserstein distance of chord lengths, mean over phases and four directions
    double thickness = 0.0;  ///< the same of the distances to the other phase, mean over phases

    /// Bidirectional patch similarity.
    [[nodiscard]] double patches() const { return 0.5 * (completeness + coherence); }
};

/// Of lists of equal weight.
Likeness mean_of(const std::vector<Likeness>& values);

struct MeterSettings {
    std::size_t samples = 500;  ///< windows compared per level and direction
    int levels = 3;
    std::uint64_t seed = 1;
};

/// Prepares an exemplar once; then measures any number of outputs.
class LikenessMeter {
  public:
    /// \param exemplar  at one pixel per pixel of the outputs; at least 7 * 2^(levels - 1) + 2^levels px per side
    explicit LikenessMeter(PatternPicture exemplar, const MeterSettings& settings = {});
    ~LikenessMeter();
    LikenessMeter(const LikenessMeter&) = delete;
    LikenessMeter& operator=(const LikenessMeter&) = delete;

    /// Of a flat output. Cost: some tenths of a second for outputs of 160 x 160 pixels.
    [[nodiscard]] Likeness measure(const PatternPicture& output) const;

    /// Of windows alone, as they are gathered on curved surfaces; `by_level[l]` on level l. Leaves the shapes and the
    /// solid fraction at 0.
    [[nodiscard]] Likeness measure(const std::vector<Windows>& by_level) const;

  private:
    struct Level;
    void measure_level(std::size_t l, const Windows& queries, const Windows& pool, Likeness& result) const;

    PatternPicture exemplar_;
    MeterSettings settings_;
    std::vector<std::unique_ptr<Level>> levels_;
};

}  // namespace fretwork::likeness
