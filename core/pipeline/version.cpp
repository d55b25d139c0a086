#include "core/pipeline/carve.h"

namespace fretwork {

std::string version() {
    return FRETWORK_VERSION;
}

}  // namespace fretwork
