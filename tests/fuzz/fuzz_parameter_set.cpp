#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "formats/parameter_set_reader.h"

// Anything but a mesh, picture or document and the errors the header names is a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    try {
        for (const std::string& set : fretwork::list_parameter_sets(bytes, "fuzz"))
            fretwork::read_parameter_set(bytes, "fuzz", set);
    } catch (const fretwork::InvalidInput&) {
    }
    return 0;
}
