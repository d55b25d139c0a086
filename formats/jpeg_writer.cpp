#include "formats/jpeg_writer.h"

// jpeglib.h needs the types of <cstdio> and <cstddef> declared before it.
#include <cstddef>
#include <cstdio>
#include <cstdlib>

#include <jpeglib.h>

#include <array>
#include <vector>

#include "core/base/error.h"

namespace fretwork {
namespace {

constexpr int kMostSide = 65500;

/// Owner of the compressor and of the bytes that libjpeg allocates.
class JpegTarget {
  public:
    JpegTarget() {
        jpeg_.err = jpeg_std_error(&errors_);
        errors_.error_exit = &JpegTarget::on_error;
        jpeg_create_compress(&jpeg_);
        jpeg_mem_dest(&jpeg_, &bytes_, &size_);
    }
    ~JpegTarget() {
        jpeg_destroy_compress(&jpeg_);
        std::free(bytes_);
    }
    JpegTarget(const JpegTarget&) = delete;
    JpegTarget& operator=(const JpegTarget&) = delete;

    [[nodiscard]] jpeg_compress_struct* jpeg() { return &jpeg_; }
    [[nodiscard]] std::string bytes() const { return {reinterpret_cast<const char*>(bytes_), size_}; }

  private:
    [[noreturn]] static void on_error(j_common_ptr jpeg) {
        std::array<char, JMSG_LENGTH_MAX> message{};
        (*jpeg->err->format_message)(jpeg, message.data());
        throw InvalidInput(std::string("write jpeg: ") + message.data());
    }

    jpeg_error_mgr errors_{};
    jpeg_compress_struct jpeg_{};
    unsigned char* bytes_ = nullptr;
    unsigned long size_ = 0;
};

}  // namespace

std::string write_jpeg(const Image& image, int quality) {
    if (image.width < 1 || image.height < 1 || image.width > kMostSide || image.height > kMostSide ||
        image.pixels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
        throw InvalidInput("write jpeg: found " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                           " with " + std::to_string(image.pixels.size()) + " pixels, expected them to agree");
    JpegTarget target;
    jpeg_compress_struct& jpeg = *target.jpeg();
    jpeg.image_width = static_cast<JDIMENSION>(image.width);
    jpeg.image_height = static_cast<JDIMENSION>(image.height);
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, quality, TRUE);
    jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = 1;
    jpeg.dct_method = JDCT_ISLOW;
    jpeg.optimize_coding = TRUE;
    jpeg_start_compress(&jpeg, TRUE);
    std::vector<JSAMPLE> row(3 * static_cast<std::size_t>(image.width));
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x)
            for (std::size_t k = 0; k < 3; ++k) row[3 * static_cast<std::size_t>(x) + k] = image.at(x, y)[k];
        JSAMPROW line = row.data();
        jpeg_write_scanlines(&jpeg, &line, 1);
    }
    jpeg_finish_compress(&jpeg);
    return target.bytes();
}

}  // namespace fretwork
