#include "formats/volumetric_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <map>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "formats/parse_error.h"
#include "formats/png_reader.h"
#include "formats/threemf_build.h"
#include "formats/threemf_package.h"
#include "formats/threemf_reader.h"
#include "formats/voxel_stack.h"

namespace fretwork {
namespace {

using threemf::TileStyle;

constexpr std::uint64_t kMaxSheetBytes = 64 << 20;
constexpr std::size_t kMaxShownSamples = std::size_t{1} << 30;
/// Of sheets that are unpacked together, which bounds the memory whatever the number of threads.
constexpr std::size_t kPixelsAtOnce = std::size_t{1} << 21;

std::int64_t cell_of(std::int64_t i, std::int64_t count, TileStyle style) {
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
    const VoxelStack* stack = nullptr;
    threemf::ImageFunction function;
    Eigen::Affine3d to_unit_cube = Eigen::Affine3d::Identity();
    std::size_t first = 0;  ///< channel; a vector takes three

    [[nodiscard]] double value(const Vec3& point_mm, std::size_t channel) const {
        Vec3 uvw = to_unit_cube * point_mm;
        uvw[1] = 1.0 - uvw[1];  // Row 0 lies at V = 1.
        // A point far outside is nearest to the same cell as one a million cells away.
        for (int k = 0; k < 3; ++k) uvw[k] = std::clamp(uvw[k], -1e6, 1e6);
        const std::array<std::int64_t, 3> count = {stack->columns(), stack->rows(), stack->sheets()};
        const double raw = function.nearest ? nearest(uvw, count, channel) : linear(uvw, count, channel);
        return raw * function.scale + function.offset;
    }

  private:
    [[nodiscard]] double cell(const std::array<std::int64_t, 3>& i, const std::array<std::int64_t, 3>& count,
                              std::size_t channel) const {
        return stack->at(cell_of(i[0], count[0], function.tile[0]), cell_of(i[1], count[1], function.tile[1]),
                         cell_of(i[2], count[2], function.tile[2]), channel);
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
    std::vector<std::shared_ptr<const VoxelStack>> stacks;  ///< what the channels point to
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
    VolumetricLoader(const threemf::Package& package, const threemf::Model& model, std::string_view source,
                     std::size_t max_samples, const RunControl& run)
        : package_(package), model_(model), source_(source), max_samples_(max_samples), run_(run) {}

    std::vector<VolumetricObject> load() {
        std::vector<VolumetricObject> objects;
        for (const auto& [id, object] : model_.objects) {
            if (object.volume == 0) continue;
            auto impl = std::make_unique<VolumetricObject::Impl>();
            impl->name = object.name;
            for (const threemf::VolumeProperty& property : find(model_.volumes, object.volume, "volumedata")) {
                if (!property.name.empty() && property.name.find(':') == std::string::npos)
                    fail("property " + in_quotes(property.name), "a name with the prefix of whoever defines it");
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

    const VoxelStack* stack_of(threemf::ResourceId id) {
        if (const auto known = stacks_.find(id); known != stacks_.end()) return known->second.get();
        const threemf::Image3d& image = find(model_.images, id, "image3d");
        auto stack = std::make_shared<VoxelStack>();
        const auto pixels = static_cast<std::size_t>(image.columns * image.rows);
        const std::size_t batch = std::max<std::size_t>(1, kPixelsAtOnce / pixels);
        for (std::size_t begin = 0; begin < image.sheets.size(); begin += batch)
            append_sheets(*stack, image, begin, std::min(image.sheets.size(), begin + batch));
        return (stacks_[id] = std::move(stack)).get();
    }

    /// Unpacks some sheets at once, each on any thread, and adds them in order.
    void append_sheets(VoxelStack& stack, const threemf::Image3d& image, std::size_t begin, std::size_t end) {
        std::vector<std::string> files(end - begin);
        for (std::size_t i = 0; i < files.size(); ++i) {
            const std::string& path = image.sheets[begin + i];
            if (!package_.contains(path)) fail("no sheet " + in_quotes(path), "one");
            files[i] = package_.read_part(path, kMaxSheetBytes);
        }
        std::vector<TiledSheet> sheets(files.size());
        std::vector<std::exception_ptr> broken(files.size());
        parallel_for(files.size(), 1, [&](std::size_t i) {
            run_.throw_if_stopped();
            try {
                sheets[i] = tiled(read_raw_png(files[i], source_ + ": " + image.sheets[begin + i],
                                               {.max_side_px = 1024, .max_pixels = 1 << 20}));
            } catch (const InvalidInput&) {
                broken[i] = std::current_exception();
            }
        });
        for (std::size_t i = 0; i < sheets.size(); ++i) {
            if (broken[i]) std::rethrow_exception(broken[i]);
            append_sheet(stack, image, sheets[i], image.sheets[begin + i]);
        }
    }

    void append_sheet(VoxelStack& stack, const threemf::Image3d& image, const TiledSheet& sheet,
                      const std::string& path) {
        if (sheet.width != image.columns || sheet.height != image.rows)
            fail("sheet " + in_quotes(path) + " of " + std::to_string(sheet.width) + " x " +
                     std::to_string(sheet.height),
                 std::to_string(image.columns) + " x " + std::to_string(image.rows));
        if (!stack.takes(sheet))
            fail("sheet " + in_quotes(path) + " of another layout than the first", "one layout per stack");
        samples_ += sheet.samples.size();
        shown_samples_ +=
            static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(sheet.height) * sheet.channels;
        if (samples_ > max_samples_ || shown_samples_ > kMaxShownSamples)
            fail("over " + std::to_string(max_samples_) + " samples to be stored or " +
                     std::to_string(kMaxShownSamples) + " to be unpacked",
                 "fewer");
        stack.add(sheet);
    }

    const threemf::Package& package_;
    const threemf::Model& model_;
    std::string source_;
    std::size_t max_samples_;
    const RunControl& run_;
    std::map<threemf::ResourceId, std::shared_ptr<const VoxelStack>> stacks_;
    std::size_t samples_ = 0;
    std::size_t shown_samples_ = 0;  ///< with those of tiles that are held as one pixel
};

std::vector<VolumetricObject> read_volumetric_threemf(std::string_view bytes, std::string_view source,
                                                      std::size_t max_samples, const RunControl& run) {
    const threemf::Package package(bytes, source);
    const threemf::Model model = package.read_model(package.model_part(), /*ignore_required=*/false, run);
    return VolumetricLoader(package, model, source, max_samples, run).load();
}

VolumetricFile read_threemf_with_volumes(std::string_view bytes, std::string_view source, const RunControl& run,
                                         const ThreemfReadOptions& options) {
    threemf::Build build(bytes, source, options, run);
    VolumetricFile file;
    file.objects = VolumetricLoader(build.package(), build.root(), source, kMaxStoredSamples, run).load();
    file.mesh = flatten_build(std::move(build), {}, run);
    return file;
}

}  // namespace fretwork
