#include "formats/jpeg_reader.h"

// jpeglib.h needs the types of <cstdio> and <cstddef> declared before it.
#include <cstddef>
#include <cstdio>
// Keep the two groups apart.
#include <jpeglib.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "formats/parse_error.h"

namespace fretwork {
namespace {

/// Owner of the decompressor. The error function throws instead of leaving the process; libjpeg-turbo
/// is built with unwind tables, and what it allocates belongs to the pool freed by the destructor.
class JpegSource {
  public:
    JpegSource(std::string_view bytes, std::string_view source) : bytes_(bytes), source_(source) {
        jpeg_.err = jpeg_std_error(&errors_);
        errors_.error_exit = &JpegSource::on_error;
        errors_.emit_message = &JpegSource::on_message;
        jpeg_.client_data = this;
        jpeg_create_decompress(&jpeg_);
        progress_.progress_monitor = &JpegSource::on_progress;
        jpeg_.progress = &progress_;
        jpeg_mem_src(&jpeg_, reinterpret_cast<const unsigned char*>(bytes.data()),
                     static_cast<unsigned long>(bytes.size()));
    }
    ~JpegSource() { jpeg_destroy_decompress(&jpeg_); }
    JpegSource(const JpegSource&) = delete;
    JpegSource& operator=(const JpegSource&) = delete;

    [[nodiscard]] jpeg_decompress_struct* jpeg() { return &jpeg_; }

    [[noreturn]] void fail(std::string_view found, std::string_view expected) const {
        const std::size_t left = jpeg_.src != nullptr ? jpeg_.src->bytes_in_buffer : 0;
        fail_parse(source_, place_of_byte(bytes_.size() - std::min(left, bytes_.size())), found, expected);
    }

  private:
    [[noreturn]] static void on_error(j_common_ptr jpeg) {
        char message[JMSG_LENGTH_MAX];
        (*jpeg->err->format_message)(jpeg, message);
        static_cast<const JpegSource*>(jpeg->client_data)->fail(in_quotes(message), "a sound JPEG");
    }
    /// Level -1 is a warning about broken data that libjpeg would paint over in grey.
    static void on_message(j_common_ptr jpeg, int level) {
        if (level < 0) on_error(jpeg);
    }

    /// A progressive picture may repeat its scans at a few bytes each; every one costs a pass over all pixels.
    static void on_progress(j_common_ptr jpeg) {
        constexpr int kMaxScans = 200;
        if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number > kMaxScans)
            static_cast<const JpegSource*>(jpeg->client_data)->fail("over 200 scans", "fewer");
    }

    std::string_view bytes_;
    std::string_view source_;
    jpeg_progress_mgr progress_{};
    jpeg_error_mgr errors_{};
    jpeg_decompress_struct jpeg_{};
};

unsigned exif_number(const JOCTET* at, int size, bool little) {
    unsigned value = 0;
    for (int i = 0; i < size; ++i) value = value << 8 | at[little ? size - 1 - i : i];
    return value;
}

/// EXIF orientation 1..8; 1 where there is none or it makes no sense.
int orientation_of(const jpeg_decompress_struct& jpeg) {
    constexpr std::string_view kExif("Exif\0\0", 6);
    for (auto* marker = jpeg.marker_list; marker != nullptr; marker = marker->next) {
        const std::size_t size = marker->data_length;
        if (marker->marker != JPEG_APP0 + 1 || size < 20 ||
            std::string_view(reinterpret_cast<const char*>(marker->data), 6) != kExif)
            continue;
        const JOCTET* tiff = marker->data + 6;
        const bool little = tiff[0] == 'I';
        const std::size_t directory = exif_number(tiff + 4, 4, little);
        if (directory > size - 6 - 2) return 1;
        const std::size_t entries = exif_number(tiff + directory, 2, little);
        for (std::size_t i = 0; i < entries && directory + 2 + 12 * (i + 1) <= size - 6; ++i) {
            const JOCTET* entry = tiff + directory + 2 + 12 * i;
            if (exif_number(entry, 2, little) != 0x0112) continue;
            const auto value = static_cast<int>(exif_number(entry + 8, 2, little));
            return value >= 1 && value <= 8 ? value : 1;
        }
    }
    return 1;
}

Image upright(const Image& stored, int orientation) {
    if (orientation == 1) return stored;
    const bool swapped = orientation >= 5;
    Image image = stored;
    if (swapped) std::swap(image.width, image.height);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            int u = swapped ? y : x, v = swapped ? x : y;
            if (orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8) u = stored.width - 1 - u;
            if (orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7) v = stored.height - 1 - v;
            const auto to =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
            image.pixels[to] = stored.at(u, v);
        }
    return image;
}

/// Adobe programs store ink inverted: 255 is no ink. Without a profile, inks multiply.
Rgba8 from_cmyk(const JSAMPLE* ink, bool inverted) {
    unsigned light[4];
    for (int k = 0; k < 4; ++k) light[k] = inverted ? ink[k] : 255u - ink[k];
    Rgba8 color{0, 0, 0, 255};
    for (std::size_t k = 0; k < 3; ++k) color[k] = static_cast<std::uint8_t>((light[k] * light[3] + 127) / 255);
    return color;
}

void check_size(const JpegSource& file, const jpeg_decompress_struct& jpeg, const ImageLimits& limits) {
    const auto side = static_cast<JDIMENSION>(limits.max_side_px);
    if (jpeg.image_width > side || jpeg.image_height > side ||
        static_cast<std::size_t>(jpeg.image_width) * jpeg.image_height > limits.max_pixels)
        file.fail(std::to_string(jpeg.image_width) + " x " + std::to_string(jpeg.image_height) + " pixels",
                  "at most " + std::to_string(limits.max_side_px) + " on a side and " +
                      std::to_string(limits.max_pixels) + " in all");
}

}  // namespace

Image read_jpeg(std::string_view bytes, std::string_view source, const ImageLimits& limits) {
    JpegSource file(bytes, source);
    jpeg_decompress_struct& jpeg = *file.jpeg();
    jpeg_save_markers(&jpeg, JPEG_APP0 + 1, 0xFFFF);
    jpeg_read_header(&jpeg, TRUE);
    check_size(file, jpeg, limits);
    const bool inks = jpeg.jpeg_color_space == JCS_CMYK || jpeg.jpeg_color_space == JCS_YCCK;
    jpeg.out_color_space = inks ? JCS_CMYK : JCS_RGB;
    jpeg.dct_method = JDCT_ISLOW;
    jpeg_start_decompress(&jpeg);

    Image image;
    image.width = static_cast<int>(jpeg.output_width);
    image.height = static_cast<int>(jpeg.output_height);
    image.pixels.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    std::vector<JSAMPLE> row(static_cast<std::size_t>(jpeg.output_width) *
                             static_cast<std::size_t>(jpeg.output_components));
    const bool inverted = jpeg.saw_Adobe_marker != 0;
    while (jpeg.output_scanline < jpeg.output_height) {
        JSAMPROW rows[1] = {row.data()};
        jpeg_read_scanlines(&jpeg, rows, 1);
        for (std::size_t x = 0; x < jpeg.output_width; ++x) {
            const JSAMPLE* at = row.data() + x * static_cast<std::size_t>(jpeg.output_components);
            image.pixels.push_back(inks ? from_cmyk(at, inverted) : Rgba8{at[0], at[1], at[2], 255});
        }
    }
    const int orientation = orientation_of(jpeg);
    jpeg_finish_decompress(&jpeg);
    return upright(image, orientation);
}

}  // namespace fretwork
