// What pid and p1..p3 of a 3MF point into -> colours.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/vec.h"
#include "core/exemplar/image.h"
#include "formats/threemf_model.h"
#include "formats/threemf_values.h"
#include "formats/xml_reader.h"

namespace fretwork::threemf {

/// Gives the bytes of a part of the package. \throws InvalidInput  no such part; over `max_bytes`.
using ReadPart = std::function<std::string(std::string_view path, std::uint64_t max_bytes)>;

/// Colour groups, base materials, textures, composites and multi-properties of one model part. Limits: 2^24 entries in
/// all; pictures of up to 8192 px a side, and of 16 M pixels and 64 MiB in their files together.
class Materials {
  public:
    /// Both must outlive it. \param read_part  may be empty: textures have no colour then
    Materials(const XmlReader& xml, ReadPart read_part) : xml_(xml), read_part_(std::move(read_part)) {}

    /// Whether the element is a group of properties, whose children `add_entry` takes.
    [[nodiscard]] static bool is_group(const XmlElement& e);

    /// \throws InvalidInput  an attribute that is missing or malformed; beyond the limits.
    void start_group(const XmlElement& e, ResourceId id);
    void add_entry(const XmlElement& e);
    void add_texture(const XmlElement& e, ResourceId id);

    /// The one colour that stands for a triangle: the mean of its corners', a texture's in its middle (nearest pixel).
    /// Nothing when the group is not known here or its picture cannot be read.
    /// \throws InvalidInput  an index past the end.
    [[nodiscard]] std::optional<Rgb8> color_of(ResourceId group, const std::array<std::int64_t, 3>& corners);

    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    struct Texture {
        std::string path;
        std::array<TileStyle, 2> tile = {TileStyle::kWrap, TileStyle::kWrap};
        std::optional<Image> picture;  ///< read when it is first asked for; no pixels if it cannot be
    };
    enum class Kind { kColors, kTexture, kComposite, kMulti };
    /// One list per entry, of what its kind is made of.
    struct Group {
        Kind kind = Kind::kColors;
        std::vector<Rgba8> colors;                      ///< of colours and base materials
        ResourceId refers_to = 0;                       ///< texture, or base materials of a composite
        std::vector<Vec2> coordinates;                  ///< of a texture
        std::vector<std::vector<double>> shares;        ///< of composites, one per material index
        std::vector<std::vector<std::int64_t>> layers;  ///< of multi-properties, one per group
        std::vector<std::int64_t> indices;              ///< material indices, or groups of the layers
        std::vector<bool> multiplied;                   ///< of layers from the second on; else mixed
    };
    using Corners = std::array<std::int64_t, 3>;

    [[nodiscard]] std::vector<std::int64_t> whole_numbers(std::string_view text, std::string_view what) const;
    [[nodiscard]] std::optional<Rgba8> color(ResourceId group, const Corners& corners, bool within_multi);
    [[nodiscard]] std::optional<Rgba8> sampled(const Group& group, const Corners& corners);
    [[nodiscard]] std::optional<Rgba8> composed(const Group& group, const Corners& corners);
    [[nodiscard]] std::optional<Rgba8> layered(const Group& group, const Corners& corners);
    const Image* picture_of(ResourceId texture);
    void check_index(std::int64_t index, std::size_t count) const;

    const XmlReader& xml_;
    ReadPart read_part_;
    ThreemfValues values_{xml_};
    std::map<ResourceId, Group> groups_;
    std::map<ResourceId, Texture> textures_;
    Group* open_ = nullptr;
    std::size_t entries_ = 0;
    std::size_t pixels_ = 0;  ///< of the pictures read so far, and the bytes of their files
    std::uint64_t picture_bytes_ = 0;
    std::vector<std::string> warnings_;
};

}  // namespace fretwork::threemf
