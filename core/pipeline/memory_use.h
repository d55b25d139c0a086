// What a run will need and has needed of memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/mesh/triangle_mesh.h"
#include "core/pipeline/resolve_settings.h"

namespace fretwork {

/// Upper estimate of the peak of a run, from the area of the surface alone; at most half too much on the models it was
/// fitted to. \param mesh  scaled
std::uint64_t estimated_peak_bytes(const TriangleMesh& mesh, const ResolvedSettings& settings);

/// Largest resident set of this process so far (VmHWM); 0 where the system does not tell.
std::uint64_t peak_memory_bytes();

/// \throws MemoryLimit  the estimate is over `max_bytes` (0 = no limit); names the estimate and a
///                      resolution that would fit.
void check_memory(const TriangleMesh& mesh, const ResolvedSettings& settings, std::uint64_t max_bytes);

}  // namespace fretwork
