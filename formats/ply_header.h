// The first part of a PLY file: which numbers follow, and how they are written.
#pragma once

#include <bit>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fretwork {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

[[nodiscard]] std::size_t size_of(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::kFloat32;
    bool is_list = false;
    PlyType count_type = PlyType::kUint8;  ///< of lists
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;

    /// Position of a property, or the number of properties.
    [[nodiscard]] std::size_t find(std::string_view property) const;
};

struct PlyHeader {
    bool ascii = true;
    std::endian order = std::endian::little;
    std::vector<PlyElement> elements;
    std::size_t data_offset = 0;  ///< first byte behind the header
    std::size_t data_line = 0;    ///< line of that byte
};

/// \throws InvalidInput  also when the file is too short for the counts it names.
PlyHeader read_ply_header(std::string_view bytes, std::string_view source);

}  // namespace fretwork
