#include "formats/threemf_materials.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "formats/image_file.h"
#include "formats/parse_error.h"
#include "formats/text_scanner.h"
#include "formats/threemf_names.h"

namespace fretwork::threemf {
namespace {

constexpr std::size_t kMaxEntries = 1 << 24;
constexpr std::size_t kMaxLayers = 32;
constexpr std::size_t kMaxPixels = std::size_t{16} << 20;
constexpr std::uint64_t kMaxPictureBytes = std::uint64_t{64} << 20;

Rgba8 mean_of(const std::array<Rgba8, 3>& corners) {
    if (corners[0] == corners[1] && corners[1] == corners[2]) return corners[0];
    Rgba8 mean{};
    for (std::size_t k = 0; k < 4; ++k)
        mean[k] = static_cast<std::uint8_t>((corners[0][k] + corners[1][k] + corners[2][k] + 1) / 3);
    return mean;
}

/// The pixel that a coordinate in [0, 1] falls on, or would without end.
int tiled(double unit, int count, TileStyle style) {
    if (style == TileStyle::kWrap) unit -= std::floor(unit);
    if (style == TileStyle::kMirror) {
        unit -= 2.0 * std::floor(unit / 2.0);
        if (unit > 1.0) unit = 2.0 - unit;
    }
    return static_cast<int>(std::floor(std::clamp(unit * count, 0.0, count - 1.0)));
}

/// A layer on top of another: multiplied with it, or covering it as far as it is opaque.
Rgba8 put_on(const Rgba8& below, const Rgba8& top, bool multiplied) {
    Rgba8 result = below;
    for (std::size_t k = 0; k < 3; ++k) {
        const double a = top[3] / 255.0;
        const double value = multiplied ? below[k] * top[k] / 255.0 : a * top[k] + (1.0 - a) * below[k];
        result[k] = static_cast<std::uint8_t>(std::lround(value));
    }
    return result;
}

}  // namespace

bool Materials::is_group(const XmlElement& e) {
    if (e.space == kCore) return e.name == "basematerials";
    return e.space == kMaterial && (e.name == "colorgroup" || e.name == "texture2dgroup" ||
                                    e.name == "compositematerials" || e.name == "multiproperties");
}

void Materials::start_group(const XmlElement& e, ResourceId id) {
    open_ = &groups_[id];
    if (e.name == "texture2dgroup") {
        open_->kind = Kind::kTexture;
        open_->refers_to = values_.id(e, "texid");
    } else if (e.name == "compositematerials") {
        open_->kind = Kind::kComposite;
        open_->refers_to = values_.id(e, "matid");
        open_->indices = whole_numbers(values_.need(e, "matindices"), "matindices");
    } else if (e.name == "multiproperties") {
        open_->kind = Kind::kMulti;
        open_->indices = whole_numbers(values_.need(e, "pids"), "pids");
        TextScanner words(e.find("blendmethods").value_or(""), "", {.comment = 0});
        for (std::string_view word = words.word(); !word.empty(); word = words.word())
            open_->multiplied.push_back(word == "multiply");
    }
}

void Materials::add_entry(const XmlElement& e) {
    if (++entries_ > kMaxEntries) xml_.fail("over 16777216 colours", "fewer");
    switch (open_->kind) {
        case Kind::kColors:
            open_->colors.push_back(values_.color(values_.need(e, e.name == "base" ? "displaycolor" : "color")));
            break;
        case Kind::kTexture:
            open_->coordinates.emplace_back(values_.number(values_.need(e, "u"), "u"),
                                            values_.number(values_.need(e, "v"), "v"));
            break;
        case Kind::kComposite: {
            std::vector<double> shares;
            TextScanner words(values_.need(e, "values"), "", {.comment = 0});
            for (std::string_view word = words.word(); !word.empty() && shares.size() < kMaxLayers; word = words.word())
                shares.push_back(std::max(0.0, values_.number(word, "values")));
            open_->shares.push_back(std::move(shares));
            break;
        }
        case Kind::kMulti:
            open_->layers.push_back(whole_numbers(values_.need(e, "pindices"), "pindices"));
            break;
    }
}

void Materials::add_texture(const XmlElement& e, ResourceId id) {
    Texture& texture = textures_[id];
    texture.path = values_.need(e, "path");
    static constexpr std::array<std::string_view, 2> kNames = {"tilestyleu", "tilestylev"};
    for (std::size_t k = 0; k < 2; ++k)
        texture.tile[k] = e.find(kNames[k]) == "none" ? TileStyle::kClamp : values_.tile_style(e, kNames[k]);
}

std::vector<std::int64_t> Materials::whole_numbers(std::string_view text, std::string_view what) const {
    std::vector<std::int64_t> numbers;
    TextScanner words(text, "", {.comment = 0});
    for (std::string_view word = words.word(); !word.empty(); word = words.word()) {
        if (numbers.size() >= kMaxLayers) xml_.fail("over 32 " + std::string(what), "fewer");
        numbers.push_back(values_.whole(word, what, 0, kMaxId));
    }
    return numbers;
}

void Materials::check_index(std::int64_t index, std::size_t count) const {
    if (index >= static_cast<std::int64_t>(count))
        xml_.fail("colour index " + std::to_string(index), "one below " + std::to_string(count));
}

std::optional<Rgb8> Materials::color_of(ResourceId group, const Corners& corners) {
    const auto found = color(group, corners, /*within_multi=*/false);
    if (!found) return std::nullopt;
    return Rgb8{(*found)[0], (*found)[1], (*found)[2]};
}

std::optional<Rgba8> Materials::color(ResourceId id, const Corners& corners, bool within_multi) {
    const auto known = groups_.find(id);
    if (known == groups_.end()) return std::nullopt;
    const Group& group = known->second;
    switch (group.kind) {
        case Kind::kColors: {
            std::array<Rgba8, 3> colors{};
            for (std::size_t k = 0; k < 3; ++k) {
                check_index(corners[k], group.colors.size());
                colors[k] = group.colors[static_cast<std::size_t>(corners[k])];
            }
            return mean_of(colors);
        }
        case Kind::kTexture:
            return sampled(group, corners);
        case Kind::kComposite:
            return composed(group, corners);
        case Kind::kMulti:
            break;
    }
    // The specification forbids layers of layers.
    return within_multi ? std::nullopt : layered(group, corners);
}

std::optional<Rgba8> Materials::sampled(const Group& group, const Corners& corners) {
    Vec2 middle = Vec2::Zero();
    for (const std::int64_t corner : corners) {
        check_index(corner, group.coordinates.size());
        middle += group.coordinates[static_cast<std::size_t>(corner)] / 3.0;
    }
    const Image* picture = picture_of(group.refers_to);
    if (picture == nullptr) return std::nullopt;
    const std::array<TileStyle, 2>& tile = textures_.at(group.refers_to).tile;
    // v grows upward, rows grow downward.
    const int row = picture->height - 1 - tiled(middle.y(), picture->height, tile[1]);
    return picture->at(tiled(middle.x(), picture->width, tile[0]), row);
}

std::optional<Rgba8> Materials::composed(const Group& group, const Corners& corners) {
    // Of nothing but base materials: a composite of itself would never end.
    const auto bases = groups_.find(group.refers_to);
    if (bases == groups_.end() || bases->second.kind != Kind::kColors) return std::nullopt;
    std::array<Rgba8, 3> colors{};
    for (std::size_t k = 0; k < 3; ++k) {
        check_index(corners[k], group.shares.size());
        const std::vector<double>& shares = group.shares[static_cast<std::size_t>(corners[k])];
        Vec3 sum = Vec3::Zero();
        double total = 0.0;
        for (std::size_t i = 0; i < std::min(shares.size(), group.indices.size()); ++i) {
            check_index(group.indices[i], bases->second.colors.size());
            const Rgba8& base = bases->second.colors[static_cast<std::size_t>(group.indices[i])];
            sum += shares[i] * Vec3(base[0], base[1], base[2]);
            total += shares[i];
        }
        if (total <= 0.0) return std::nullopt;
        for (int c = 0; c < 3; ++c)
            colors[k][static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(std::lround(sum[c] / total));
        colors[k][3] = 255;
    }
    return mean_of(colors);
}

std::optional<Rgba8> Materials::layered(const Group& group, const Corners& corners) {
    for (const std::int64_t corner : corners) check_index(corner, group.layers.size());
    std::optional<Rgba8> result;
    for (std::size_t layer = 0; layer < group.indices.size(); ++layer) {
        Corners indices{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::vector<std::int64_t>& entry = group.layers[static_cast<std::size_t>(corners[k])];
            indices[k] = layer < entry.size() ? entry[layer] : 0;  // Indices may be left out at the end.
        }
        const auto top = color(static_cast<ResourceId>(group.indices[layer]), indices, /*within_multi=*/true);
        if (!top) continue;
        const bool multiplied = layer > 0 && layer - 1 < group.multiplied.size() && group.multiplied[layer - 1];
        result = result ? put_on(*result, *top, multiplied) : *top;
    }
    return result;
}

const Image* Materials::picture_of(ResourceId id) {
    const auto known = textures_.find(id);
    if (known == textures_.end() || !read_part_) return nullptr;
    Texture& texture = known->second;
    if (!texture.picture) {
        texture.picture.emplace();
        try {
            const ImageLimits limits{.max_side_px = 8192, .max_pixels = kMaxPixels - pixels_};
            const std::string bytes = read_part_(texture.path, kMaxPictureBytes - picture_bytes_);
            picture_bytes_ += bytes.size();
            texture.picture = read_image(bytes, texture.path, limits);
            pixels_ += texture.picture->pixels.size();
        } catch (const InvalidInput& unreadable) {
            warnings_.push_back(std::string("texture left out: ") + unreadable.what());
        }
    }
    return texture.picture->pixels.empty() ? nullptr : &*texture.picture;
}

}  // namespace fretwork::threemf
