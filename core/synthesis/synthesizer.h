// Stage 3: exemplar + pyramid -> labels. Algorithms 2 and 3, and the re-synthesis of section 4.4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/run_control.h"
#include "core/exemplar/exemplar.h"
#include "core/pyramid/voxel_pyramid.h"
#include "core/synthesis/labels.h"

namespace fretwork {

enum class Orientation {
    kFree,    ///< every rotation is as good as any other
    kVector,  ///< the picture's up follows the projection of `direction` onto the surface
};

struct SynthesisSettings {
    std::uint64_t seed = 1;
    /// Exemplar pixels per voxel of the finest level, in (0, 64]. 1 keeps one pixel per voxel.
    double pixels_per_voxel = 1.0;
    Orientation orientation = Orientation::kVector;
    Vec3 direction = Vec3::UnitZ();  ///< with Orientation::kVector; any length but zero
    bool symmetric = false;          ///< with kVector: up and down are the same
    /// Length over which the field of directions is evened out, as a share of the object's longest
    /// side, in [0, 1]; 0 is the naive projection of the paper.
    double orientation_smoothing = 0.06;

    int directions = 300;    ///< |Psi|, in [6, 4096]; 26 gives the paper's set, otherwise a spiral on the sphere
    int rotations = 1024;    ///< linear parts of Gamma per direction, in [1, 4096]
    int translations = 0;    ///< per axis, in [0, 1024]; 0 = continuous; the paper: 16
    double cone_deg = 25.0;  ///< random planes lie within this angle of the voxel's normal, in [0, 90]

    int candidates = 64;              ///< coherent, transported and random together, in [1, 256]
    int fine_random_candidates = 24;  ///< most random ones on the two finest levels, in [0, 256]
    int transported = 4;              ///< coherent ones moved to the voxel's own best plane, levels >= 2, in [0, 64]
    bool count_repeated = false;      ///< neighbours that agree use up one candidate each, as in the paper

    double distortion_weight = 1.0;   ///< of E_distortion, in [0, 100]
    double orientation_weight = 2.0;  ///< of 1 - cos(angle to the field), in [0, 100]
    double border_weight = 0.5;       ///< of texels near the border of a picture that does not tile, in [0, 100]
    double border_band = 0.05;        ///< what counts as near, as a share of the side, in [0, 0.4]
    double feature_weight = 1.0;      ///< of f against one colour channel, in [0, 1]
    bool normalize_energy = true;     ///< divide the colour sum by the number of neighbours

    bool random_start = true;        ///< else every voxel starts from label (0, 0) as in Algorithm 2
    int coarse_passes = 8;           ///< passes per level, finest first: 1, 2, 4, ... up to this, in [1, 64]
    double jitter = 0.05;            ///< share of voxels relabelled at random per level, in [0, 1]
    int jitter_from_level = 2;       ///< finer levels are left alone; 0 with the paper
    std::optional<int> start_level;  ///< else the finest one on which the blurred exemplar is nearly flat

    /// Finer levels that are left out, in [0, 10]: the run does what one on a shell of 2^skipped_levels times the
    /// resolution does down to this level, with the same passes, candidates and random numbers.
    int skipped_levels = 0;

    bool portable_code = false;  ///< for tests: no special instructions; labels are the same
};

/// The state of one pattern on one shell. Keeps references: pyramid and exemplar must outlive it.
///
/// Results depend on the arguments and the seed alone: voxels are updated in sub-passes that read a
/// snapshot, random numbers are counted, energies are integers, ties go to the lower label.
class Synthesizer {
  public:
    /// \throws InvalidSetting  a setting outside its range.
    Synthesizer(const VoxelPyramid& pyramid, const Exemplar& exemplar, const SynthesisSettings& settings);
    ~Synthesizer();
    Synthesizer(Synthesizer&&) noexcept;
    Synthesizer& operator=(Synthesizer&&) noexcept;

    /// SYNTHESIZE: the whole pyramid from the start level down to 0.
    void synthesize(const RunControl& run = {});

    /// RESYNTHESIZE: voxels marked in `forced_solid` (one byte per finest voxel) take only labels that
    /// project them onto solid; voxels below the coarsest marked parent, `log2(pattern_radius)` levels
    /// up, adapt; all others keep their labels bit for bit.
    /// Cost proportional to the voxels below `changed`, the newly marked ones.
    /// \return the finest voxels whose label changed, ascending.
    /// \throws InvalidInput  before `synthesize`, sizes or indices that do not fit the shell;
    ///         InvalidSetting  a radius that is not positive; Cancelled, with all labels as they were.
    std::vector<VoxelIndex> resynthesize(const std::vector<std::uint8_t>& forced_solid,
                                         const std::vector<VoxelIndex>& changed, double pattern_radius_voxels,
                                         const RunControl& run = {});

    /// Labels of the finest level.
    [[nodiscard]] const TexelFrames& frames() const;

    /// Bytes held, without pyramid and exemplar.
    [[nodiscard]] std::size_t memory_bytes() const;

    /// Sum over the finest voxels of the energy of section 4.2.2 (with the weights of the settings).
    [[nodiscard]] double energy() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fretwork
