// Names that slicers give to objects outside of the model.
#pragma once

#include <map>
#include <string>

#include "formats/threemf_model.h"
#include "formats/threemf_package.h"

namespace fretwork::threemf {

/// From the configurations of PrusaSlicer and of BambuStudio and OrcaSlicer, by number of the object in the root part.
/// A configuration that cannot be read has no names.
std::map<ResourceId, std::string> slicer_names(const Package& package);

}  // namespace fretwork::threemf
