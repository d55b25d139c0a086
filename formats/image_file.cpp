#include "formats/image_file.h"

#include "formats/atomic_write.h"
#include "formats/jpeg_reader.h"
#include "formats/parse_error.h"
#include "formats/png_reader.h"
#include "formats/png_writer.h"
#include "formats/read_file.h"

namespace fretwork {
namespace {

/// What the first bytes say about pictures that are not read, to say so by name.
std::string_view other_format(std::string_view bytes) {
    if (bytes.starts_with("GIF8")) return "a GIF";
    if (bytes.starts_with("BM")) return "a BMP";
    if (bytes.starts_with("RIFF") && bytes.size() >= 12 && bytes.substr(8, 4) == "WEBP") return "a WebP";
    if (bytes.starts_with(std::string_view("II*\0", 4)) || bytes.starts_with(std::string_view("MM\0*", 4)))
        return "a TIFF";
    if (bytes.starts_with("<svg") || bytes.starts_with("<?xml")) return "an SVG or other XML";
    return {};
}

}  // namespace

Image read_image(std::string_view bytes, std::string_view source, const ImageLimits& limits) {
    if (bytes.empty()) fail_parse(source, place_of_byte(0), "an empty file", "a PNG or JPEG picture");
    if (bytes.starts_with("\x89PNG")) return read_png(bytes, source, limits);
    if (bytes.starts_with("\xFF\xD8")) return read_jpeg(bytes, source, limits);
    const std::string_view other = other_format(bytes);
    fail_parse(source, place_of_byte(0), other.empty() ? in_quotes(bytes.substr(0, 8)) : std::string(other),
               "a PNG or JPEG picture");
}

Image read_image(const std::filesystem::path& path, const ImageLimits& limits) {
    return read_image(read_file(path), path.string(), limits);
}

void write_image(const std::filesystem::path& path, const Image& image) {
    atomic_write(path, write_png(image));
}

}  // namespace fretwork
