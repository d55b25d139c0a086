// Stage 3: exemplar + pyramid -> labels. Algorithms 2 and 3, and the re-synthesis of section 4.4.
#pragma once

#include <cstdint>
#include <memory>
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
    /// Exemplar pixels per voxel of the finest level. 1 keeps one pixel per voxel.
    double pixels_per_voxel = 1.0;
    Orientation orientation = Orientation::kVector;
    Vec3 direction = Vec3::UnitZ();  ///< with Orientation::kVector; any length but zero
    bool symmetric = false;          ///< with kVector: up and down are the same
    double jitter = 0.05;            ///< share of voxels relabelled at random per coarse level, in [0, 1]
    int candidates = 40;             ///< coherent and random together, in [1, 256]
    int fine_random_candidates = 8;  ///< random ones on the two finest levels
    int directions = 300;            ///< |Psi|; 26 gives the paper's set, otherwise a spiral on the sphere
    int rotations = 1024;            ///< linear parts of Gamma per direction
    int translations = 0;            ///< per axis; 0 = continuous; the paper: 16
    int transported = 4;             ///< coherent candidates moved to the voxel's own best plane
    double cone_deg = 25.0;          ///< random planes lie within this angle of the voxel's normal
    double distortion_weight = 1.0;  ///< against colour energy per neighbour
    double orientation_weight = 2.0;
    double border_weight = 0.5;    ///< penalty of texels near the border of a picture that does not tile
    bool normalize_energy = true;  ///< divide the colour sum by the number of neighbours
    int coarse_passes = 8;     ///< passes per level, finest first: 1, 2, 4, ... up to this; 1 = the paper's single pass
    bool random_start = true;  ///< else every voxel starts from label (0, 0) as in Algorithm 2
    int start_level = -1;      ///< hidden from users: -1 picks it from the size of the shell
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
    std::vector<VoxelIndex> resynthesize(const std::vector<std::uint8_t>& forced_solid,
                                         const std::vector<VoxelIndex>& changed, double pattern_radius_voxels,
                                         const RunControl& run = {});

    /// Labels of the finest level.
    [[nodiscard]] const TexelFrames& frames() const;

    /// Sum over the finest voxels of the energy of section 4.2.2 (with the weights of the settings).
    [[nodiscard]] double energy() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fretwork
