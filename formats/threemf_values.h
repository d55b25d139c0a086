// Attribute values of a model part, checked.
#pragma once

#include <cstdint>
#include <string_view>

#include "formats/threemf_model.h"
#include "formats/xml_reader.h"

namespace fretwork::threemf {

inline constexpr std::int64_t kMaxId = 0x7FFFFFFF;
inline constexpr std::int64_t kMaxVertexIndex = 0xFFFFFFFE;

/// Every function throws InvalidInput through the reader, which names source and line.
class ThreemfValues {
  public:
    explicit ThreemfValues(const XmlReader& xml) : xml_(xml) {}

    /// Value of an attribute that must be there.
    [[nodiscard]] std::string_view need(const XmlElement& element, std::string_view attribute) const;

    /// The whole text as an integer in [least, most]; read with 64 bits, so that nothing wraps.
    [[nodiscard]] std::int64_t whole(std::string_view text, std::string_view what, std::int64_t least,
                                     std::int64_t most) const;

    /// A finite number of at most 1e9 in size.
    [[nodiscard]] double number(std::string_view text, std::string_view what) const;

    /// A number of a resource, 1 to 2^31 - 1, in an attribute that must be there.
    [[nodiscard]] ResourceId id(const XmlElement& element, std::string_view attribute) const;

    /// #RRGGBB or #RRGGBBAA.
    [[nodiscard]] Rgba8 color(std::string_view text) const;

    /// Twelve numbers that do not flatten space.
    [[nodiscard]] Eigen::Affine3d transform(std::string_view text) const;

    /// wrap (where there is none), mirror or clamp.
    [[nodiscard]] TileStyle tile_style(const XmlElement& element, std::string_view attribute) const;

  private:
    const XmlReader& xml_;
};

}  // namespace fretwork::threemf
