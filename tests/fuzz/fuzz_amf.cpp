#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/error.h"
#include "formats/amf_reader.h"

// Anything but a mesh, picture or document and the errors the header names is a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    try {
        fretwork::read_amf(bytes, "fuzz");
    } catch (const fretwork::InvalidInput&) {
    }
    return 0;
}
