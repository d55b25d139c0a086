#include "formats/volumetric_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "formats/parse_error.h"
#include "formats/png_reader.h"
#include "formats/threemf_package.h"

namespace fretwork {
namespace {

using threemf::TileStyle;

constexpr std::uint64_t kMaxSheetBytes = 64 << 20;

/// Pixels of all sheets, sheet by sheet, row 0 at the highest y.
struct Stack {
    std::int64_t columns = 0, rows = 0, sheets = 0;
    std::size_t channels = 0;
    double full = 255.0;  ///< the sample that stands for one
    std::vector<std::uint16_t> samples;

    /// Channel 0..2 red, green, blue, 3 alpha, in [0, 1]. Grey stands for all three colours; a missing
    /// alpha is one.
    [[nodiscard]] double at(std::int64_t column, std::int64_t row, std::int64_t sheet, std::size_t channel) const {
        const bool has_alpha = channels == 2 || channels == 4;
        if (channel == 3 && !has_alpha) return 1.0;
        const std::size_t c = channel == 3 ? channels - 1 : channels < 3 ? 0 : channel;
        const auto pixel = static_cast<std::size_t>((sheet * rows + row) * columns + column);
        return samples[pixel * channels + c] / full;
    }
};

std::int64_t tiled(std::int64_t i, std::int64_t count, TileStyle style) {
    switch (style) {
        case TileStyle::kWrap:
            return ((i % count) + count) % count;
        case TileStyle::kMirror: {
            const std::int64_t folded = ((i % (2 * count)) + 2 * count) % (2 * count);
            return folded < count ? folded : 2 * count - 1 - folded;
        }
        case TileStyle::kClamp:
            break;
    }
    return std::clamp<std::int64_t>(i, 0, count - 1);
}

struct Channel {
    const Stack* stack = nullptr;
    threemf::ImageFunction function;
    Eigen::Affine3d to_unit_cube = Eigen::Affine3d::Identity();
    std::size_t first = 0;  ///< channel; a vector takes three

    [[nodiscard]] double value(const Vec3& point_mm, std::size_t channel) const {
        Vec3 uvw = to_unit_cube * point_mm;
        uvw[1] = 1.0 - uvw[1];  // Row 0 lies at V = 1.
        // A point far outside is nearest to the same cell as one a million cells away.
        for (int k = 0; k < 3; ++k) uvw[k] = std::clamp(uvw[k], -1e6, 1e6);
        const std::array<std::int64_t, 3> count = {stack->columns, stack->rows, stack->sheets};
        const double raw = function.nearest ? nearest(uvw, count, channel) : linear(uvw, count, channel);
        return raw * function.scale + function.offset;
    }

  private:
    [[nodiscard]] double cell(const std::array<std::int64_t, 3>& i, const std::array<std::int64_t, 3>& count,
                              std::size_t channel) const {
        return stack->at(tiled(i[0], count[0], function.tile[0]), tiled(i[1], count[1], function.tile[1]),
                         tiled(i[2], count[2], function.tile[2]), channel);
    }

    [[nodiscard]] double nearest(const Vec3& uvw, const std::array<std::int64_t, 3>& count, std::size_t channel) const {
        std::array<std::int64_t, 3> i{};
        for (std::size_t k = 0; k < 3; ++k)  // Ties go to the lower index.
            i[k] = static_cast<std::int64_t>(std::ceil(uvw[static_cast<int>(k)] * static_cast<double>(count[k]))) - 1;
        return cell(i, count, channel);
    }

    [[nodiscard]] double linear(const Vec3& uvw, const std::array<std::int64_t, 3>& count, std::size_t channel) const {
        std::array<std::int64_t, 3> low{};
        Vec3 share;
        for (std::size_t k = 0; k < 3; ++k) {
            const int axis = static_cast<int>(k);
            const double at = uvw[axis] * static_cast<double>(count[k]) - 0.5;
            low[k] = static_cast<std::int64_t>(std::floor(at));
            share[axis] = at - std::floor(at);
        }
        double sum = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            std::array<std::int64_t, 3> i = low;
            double weight = 1.0;
            for (std::size_t k = 0; k < 3; ++k) {
                const bool high = (corner >> k & 1) != 0;
                i[k] += high ? 1 : 0;
                weight *= high ? share[static_cast<int>(k)] : 1.0 - share[static_cast<int>(k)];
            }
            if (weight > 0.0) sum += weight * cell(i, count, channel);
        }
        return sum;
    }
};

}  // namespace

struct VolumetricObject::Impl {
    std::string name;
    std::optional<Channel> color;
    std::map<std::string, Channel, std::less<>> properties;
    std::vector<std::shared_ptr<const Stack>> stacks;  ///< what the channels point to
};

VolumetricObject::VolumetricObject(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
VolumetricObject::~VolumetricObject() = default;
VolumetricObject::VolumetricObject(VolumetricObject&&) noexcept = default;
VolumetricObject& VolumetricObject::operator=(VolumetricObject&&) noexcept = default;

const std::string& VolumetricObject::name() const {
    return impl_->name;
}

std::vector<std::string> VolumetricObject::properties() const {
    std::vector<std::string> names;
    for (const auto& [name, channel] : impl_->properties) names.push_back(name);
    return names;
}

std::optional<Vec3> VolumetricObject::color(const Vec3& point_mm) const {
    if (!impl_->color) return std::nullopt;
    Vec3 color;
    for (std::size_t k = 0; k < 3; ++k)
        color[static_cast<int>(k)] = std::clamp(impl_->color->value(point_mm, k), 0.0, 1.0);
    return color;
}

std::optional<double> VolumetricObject::property(std::string_view name, const Vec3& point_mm) const {
    const auto found = impl_->properties.find(name);
    if (found == impl_->properties.end()) return std::nullopt;
    return found->second.value(point_mm, found->second.first);
}

class VolumetricLoader {
  public:
    VolumetricLoader(std::string_view bytes, std::string_view source, std::size_t max_samples, const RunControl& run)
        : source_(source),
          max_samples_(max_samples),
          run_(run),
          package_(bytes, source),
          model_(package_.read_model(package_.model_part(), /*ignore_required=*/false, run)) {}

    std::vector<VolumetricObject> load() {
        std::vector<VolumetricObject> objects;
        for (const auto& [id, object] : model_.objects) {
            if (object.volume == 0) continue;
            auto impl = std::make_unique<VolumetricObject::Impl>();
            impl->name = object.name;
            for (const threemf::VolumeProperty& property : find(model_.volumes, object.volume, "volumedata")) {
                const Channel channel = channel_of(property);
                if (property.name.empty()) {
                    impl->color = channel;
                } else if (!impl->properties.emplace(property.name, channel).second) {
                    fail("a second property " + in_quotes(property.name), "names without repeats");
                }
            }
            for (const auto& [image, stack] : stacks_) impl->stacks.push_back(stack);
            objects.push_back(VolumetricObject(std::move(impl)));
        }
        return objects;
    }

  private:
    [[noreturn]] void fail(std::string_view found, std::string_view expected) const {
        fail_parse(source_, package_.model_part(), found, expected);
    }

    template <class Map>
    const typename Map::mapped_type& find(const Map& map, threemf::ResourceId id, std::string_view kind) const {
        const auto found = map.find(id);
        if (found == map.end()) fail("no " + std::string(kind) + " with id " + std::to_string(id), "one");
        return found->second;
    }

    Channel channel_of(const threemf::VolumeProperty& property) {
        static constexpr std::array<std::string_view, 5> kChannels = {"red", "green", "blue", "alpha", "color"};
        Channel channel;
        channel.function = find(model_.functions, property.function, "functionfromimage3d");
        channel.stack = stack_of(channel.function.image);
        const auto at = static_cast<std::size_t>(std::ranges::find(kChannels, property.channel) - kChannels.begin());
        // A colour is a vector, a property a single number.
        if (at == kChannels.size() || (at == 4) != property.name.empty())
            fail("channel " + in_quotes(property.channel),
                 "color for a colour; red, green, blue or alpha for a property");
        channel.first = at == 4 ? 0 : at;
        channel.to_unit_cube = property.transform * Eigen::Scaling(1.0 / millimeters_per(model_.unit));
        return channel;
    }

    const Stack* stack_of(threemf::ResourceId id) {
        if (const auto known = stacks_.find(id); known != stacks_.end()) return known->second.get();
        const threemf::Image3d& image = find(model_.images, id, "image3d");
        auto stack = std::make_shared<Stack>();
        stack->columns = image.columns;
        stack->rows = image.rows;
        stack->sheets = static_cast<std::int64_t>(image.sheets.size());
        for (const std::string& path : image.sheets) append_sheet(*stack, path);
        return (stacks_[id] = std::move(stack)).get();
    }

    void append_sheet(Stack& stack, const std::string& path) {
        run_.throw_if_stopped();
        if (!package_.contains(path)) fail("no sheet " + in_quotes(path), "one");
        const RawPng png = read_raw_png(package_.read_part(path, kMaxSheetBytes), source_ + ": " + path,
                                        {.max_side_px = 1024, .max_pixels = 1 << 20});
        if (png.width != stack.columns || png.height != stack.rows)
            fail("sheet " + in_quotes(path) + " of " + std::to_string(png.width) + " x " + std::to_string(png.height),
                 std::to_string(stack.columns) + " x " + std::to_string(stack.rows));
        const double full = png.bits == 16 ? 65535.0 : 255.0;
        if (stack.samples.empty()) {
            stack.channels = static_cast<std::size_t>(png.channels);
            stack.full = full;
            const auto cells = static_cast<std::size_t>(stack.columns * stack.rows * stack.sheets);
            samples_ += cells * stack.channels;
            if (samples_ > max_samples_)
                fail(std::to_string(samples_) + " samples", "at most " + std::to_string(max_samples_));
            stack.samples.reserve(cells * stack.channels);
        }
        if (static_cast<std::size_t>(png.channels) != stack.channels || full != stack.full)
            fail("sheet " + in_quotes(path) + " of another layout than the first", "one layout per stack");
        stack.samples.insert(stack.samples.end(), png.samples.begin(), png.samples.end());
    }

    std::string source_;
    std::size_t max_samples_;
    const RunControl& run_;
    threemf::Package package_;
    threemf::Model model_;
    std::map<threemf::ResourceId, std::shared_ptr<const Stack>> stacks_;
    std::size_t samples_ = 0;
};

std::vector<VolumetricObject> read_volumetric_threemf(std::string_view bytes, std::string_view source,
                                                      std::size_t max_samples, const RunControl& run) {
    return VolumetricLoader(bytes, source, max_samples, run).load();
}

}  // namespace fretwork
