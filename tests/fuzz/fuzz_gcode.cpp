#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/error.h"
#include "formats/gcode_reader.h"

// Anything but a print and the error the header names is a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    try {
        fretwork::read_gcode(bytes, "fuzz");
    } catch (const fretwork::InvalidInput&) {
    }
    return 0;
}
