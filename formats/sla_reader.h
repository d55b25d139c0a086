// Archives of pictures for resin printers -> what will be printed.
#pragma once

#include <string_view>

#include "formats/sliced_print.h"

namespace fretwork {

/// The archive (.sl1) that PrusaSlicer writes: a picture per layer, white where light falls.
/// \throws InvalidInput  not such an archive, or a picture that cannot be read.
SlicedPrint read_sla_archive(std::string_view bytes, std::string_view source);

}  // namespace fretwork
