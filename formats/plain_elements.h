// The elements that a large mesh is made of, taken straight off the text.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/mesh/triangle_mesh.h"
#include "formats/threemf_model.h"

namespace fretwork::threemf {

struct TriangleElement {
    Triangle corners{};
    ResourceId group = 0;        ///< pid; 0 for none
    std::size_t properties = 0;  ///< how many of p1, p2, p3 there are
    std::array<std::int64_t, 3> property{};
};

/// Elements as programs write them: without a prefix, ended by `/>`, and with nothing but the attributes x, y, z or
/// v1, v2, v3, pid, p1, p2, p3 in this order, each a plain number within its range. Whatever stands there in another
/// way is left to the XML reader, which knows all of XML and names mistakes.
class PlainElements {
  public:
    explicit PlainElements(std::string_view text) : at_(text.data()), end_(at_ + text.size()) {}

    /// The element at the front with the blanks before it; nothing where there is no whole one of this kind.
    std::optional<Vec3> vertex();
    std::optional<TriangleElement> triangle();

    /// What has not been taken.
    [[nodiscard]] std::string_view rest() const { return {at_, static_cast<std::size_t>(end_ - at_)}; }

    /// Line ends in what has been taken.
    [[nodiscard]] std::size_t lines() const { return lines_; }

  private:
    struct Cursor;

    const char* at_;
    const char* end_;
    std::size_t lines_ = 0;
};

}  // namespace fretwork::threemf
