#include "formats/png_writer.h"

#include <png.h>

#include <new>
#include <vector>

#include "core/base/error.h"

namespace fretwork {
namespace {

class PngTarget {
  public:
    PngTarget() {
        png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, &PngTarget::on_error, &PngTarget::on_warning);
        if (png_ != nullptr) info_ = png_create_info_struct(png_);
        if (info_ == nullptr) {
            png_destroy_write_struct(&png_, &info_);
            throw std::bad_alloc();
        }
        png_set_write_fn(png_, this, &PngTarget::on_write, &PngTarget::on_flush);
    }
    ~PngTarget() { png_destroy_write_struct(&png_, &info_); }
    PngTarget(const PngTarget&) = delete;
    PngTarget& operator=(const PngTarget&) = delete;

    [[nodiscard]] png_structp png() const { return png_; }
    [[nodiscard]] png_infop info() const { return info_; }
    std::string take() { return std::move(out_); }

  private:
    static void on_write(png_structp png, png_bytep bytes, std::size_t size) {
        static_cast<PngTarget*>(png_get_io_ptr(png))->out_.append(reinterpret_cast<const char*>(bytes), size);
    }
    static void on_flush(png_structp) {}
    [[noreturn]] static void on_error(png_structp, png_const_charp message) {
        throw InvalidInput(std::string("write png: ") + message);
    }
    static void on_warning(png_structp, png_const_charp) {}

    std::string out_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

void check_pixels(bool fits, int width, int height) {
    if (width < 1 || height < 1 || !fits)
        throw InvalidInput("write png: found " + std::to_string(width) + " x " + std::to_string(height) +
                           " pixels with another number of values, expected them to agree and at least one");
}

void start_sheet(const PngTarget& file, int width, int height, int bits, int type) {
    png_set_IHDR(file.png(), file.info(), static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits, type,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    // Sheets of a shell are mostly empty: long runs, for which the fastest level is nearly the best.
    png_set_compression_level(file.png(), 1);
    png_set_filter(file.png(), PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    png_write_info(file.png(), file.info());
}

}  // namespace

std::string write_png(const Image& image) {
    check_pixels(image.pixels.size() == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height),
                 image.width, image.height);
    PngTarget file;
    png_set_IHDR(file.png(), file.info(), static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height),
                 8, image.has_alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(file.png(), file.info(), PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_compression_level(file.png(), 4);
    png_write_info(file.png(), file.info());
    const std::size_t channels = image.has_alpha ? 4 : 3;
    std::vector<std::uint8_t> row(channels * static_cast<std::size_t>(image.width));
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x)
            for (std::size_t c = 0; c < channels; ++c)
                row[channels * static_cast<std::size_t>(x) + c] = image.at(x, y)[c];
        png_write_row(file.png(), row.data());
    }
    png_write_end(file.png(), nullptr);
    return file.take();
}

std::string write_png16(std::span<const std::uint16_t> samples, int width, int height, int channels) {
    const bool known = channels == 1 || channels == 3 || channels == 4;
    const std::size_t row_samples = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
    check_pixels(known && samples.size() == row_samples * static_cast<std::size_t>(height), width, height);
    const int type = channels == 1   ? PNG_COLOR_TYPE_GRAY
                     : channels == 3 ? PNG_COLOR_TYPE_RGB
                                     : PNG_COLOR_TYPE_RGB_ALPHA;
    PngTarget file;
    start_sheet(file, width, height, 16, type);
    std::vector<std::uint8_t> row(2 * row_samples);
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
        for (std::size_t i = 0; i < row_samples; ++i) {
            const std::uint16_t value = samples[y * row_samples + i];
            row[2 * i] = static_cast<std::uint8_t>(value >> 8);
            row[2 * i + 1] = static_cast<std::uint8_t>(value & 0xFF);
        }
        png_write_row(file.png(), row.data());
    }
    png_write_end(file.png(), nullptr);
    return file.take();
}

std::string write_png_gray8(std::span<const std::uint8_t> samples, int width, int height) {
    check_pixels(samples.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height), width, height);
    PngTarget file;
    start_sheet(file, width, height, 8, PNG_COLOR_TYPE_GRAY);
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
        png_write_row(file.png(), samples.data() + y * static_cast<std::size_t>(width));
    png_write_end(file.png(), nullptr);
    return file.take();
}

}  // namespace fretwork
