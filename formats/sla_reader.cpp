#include "formats/sla_reader.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <string>

#include "core/base/error.h"
#include "formats/image_file.h"
#include "formats/zip_reader.h"

namespace fretwork {
namespace {

constexpr std::uint64_t kMostConfigBytes = 1 << 20, kMostPictureBytes = 1 << 28;

using Config = std::map<std::string, std::string, std::less<>>;

/// Lines "key = value".
Config config_of(const std::string& text) {
    Config config;
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string line = text.substr(at, end - at);
        if (const auto equals = line.find(" = "); equals != line.npos)
            config[line.substr(0, equals)] = line.substr(equals + 3);
        at = end + 1;
    }
    return config;
}

std::optional<double> number(const Config& config, std::string_view key) {
    const auto found = config.find(key);
    if (found == config.end()) return std::nullopt;
    char* end = nullptr;
    const double value = std::strtod(found->second.c_str(), &end);
    return end == found->second.c_str() ? std::nullopt : std::optional(value);
}

bool is_dark(const ZipReader& archive, const std::string& name, std::string_view source) {
    const Image picture = read_image(archive.read(name, kMostPictureBytes), std::string(source) + ": " + name);
    return std::ranges::all_of(picture.pixels, [](const Rgba8& p) { return p[0] == 0 && p[1] == 0 && p[2] == 0; });
}

}  // namespace

SlicedPrint read_sla_archive(std::string_view bytes, std::string_view source) {
    const ZipReader archive(bytes, source);
    std::vector<ZipReader::Entry> pictures;
    Config config;
    for (const ZipReader::Entry& entry : archive.entries()) {
        if (entry.name == "config.ini") config = config_of(archive.read(entry.name, kMostConfigBytes));
        if (entry.name.ends_with(".png") && !entry.name.starts_with("thumbnail")) pictures.push_back(entry);
    }
    std::ranges::sort(pictures, {}, &ZipReader::Entry::name);
    const auto height = number(config, "layerHeight");
    if (pictures.empty() || !height || *height <= 0.0)
        throw InvalidInput(std::string(source) +
                           ": found no layers; expected an archive of pictures for resin printers");
    SlicedPrint print;
    print.seconds = number(config, "printTime");
    print.material_ml = number(config, "usedMaterial");
    // Nothing packs smaller than darkness: whatever is much larger than the smallest shows something.
    const std::uint64_t smallest = std::ranges::min(pictures, {}, &ZipReader::Entry::size).size;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const double top = static_cast<double>(i + 1) * *height;
        if (pictures[i].size > smallest + smallest / 8 || !is_dark(archive, pictures[i].name, source))
            print.layers.push_back({top, *height, {}});
        else if (!print.empty_between_mm.empty() && print.empty_between_mm.back()[1] > top - 1.5 * *height)
            print.empty_between_mm.back()[1] = top;
        else
            print.empty_between_mm.emplace_back(top - *height, top);
    }
    // What is dark at the end is just not there.
    const double high = static_cast<double>(pictures.size()) * *height;
    if (!print.empty_between_mm.empty() && print.empty_between_mm.back()[1] > high - 0.5 * *height)
        print.empty_between_mm.pop_back();
    print.max_mm[2] = print.layers.empty() ? 0.0 : print.layers.back().top_mm;
    return print;
}

}  // namespace fretwork
