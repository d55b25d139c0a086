#include "formats/png_reader.h"

#include <png.h>

#include <cstring>
#include <string>

#include "core/base/error.h"
#include "formats/parse_error.h"

namespace fretwork {
namespace {

/// libpng leaves by longjmp unless its error function throws; ours does, and every C++ object here
/// lives outside libpng's frames or is owned by this class.
class PngSource {
  public:
    PngSource(std::string_view bytes, std::string_view source) : bytes_(bytes), source_(source) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &PngSource::on_error, &PngSource::on_warning);
        if (png_ != nullptr) info_ = png_create_info_struct(png_);
        if (info_ == nullptr) {
            png_destroy_read_struct(&png_, &info_, nullptr);
            throw std::bad_alloc();
        }
        png_set_read_fn(png_, this, &PngSource::on_read);
        // Ancillary chunks can unpack to far more than they weigh.
        png_set_chunk_malloc_max(png_, 8 << 20);
        png_set_chunk_cache_max(png_, 64);
    }
    ~PngSource() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngSource(const PngSource&) = delete;
    PngSource& operator=(const PngSource&) = delete;

    [[nodiscard]] png_structp png() const { return png_; }
    [[nodiscard]] png_infop info() const { return info_; }
    [[nodiscard]] std::size_t offset() const { return at_; }

  private:
    static void on_read(png_structp png, png_bytep to, std::size_t size) {
        auto* self = static_cast<PngSource*>(png_get_io_ptr(png));
        if (self->bytes_.size() - self->at_ < size)
            fail_parse(self->source_, place_of_byte(self->bytes_.size()), "the end of the file", "more of the PNG");
        std::memcpy(to, self->bytes_.data() + self->at_, size);
        self->at_ += size;
    }
    [[noreturn]] static void on_error(png_structp png, png_const_charp message) {
        const auto* self = static_cast<const PngSource*>(png_get_error_ptr(png));
        fail_parse(self->source_, place_of_byte(self->at_), in_quotes(message), "a sound PNG");
    }
    static void on_warning(png_structp, png_const_charp) {}

    std::string_view bytes_;
    std::string_view source_;
    std::size_t at_ = 0;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

void check_size(png_uint_32 width, png_uint_32 height, std::string_view source, const ImageLimits& limits) {
    const auto side = static_cast<png_uint_32>(limits.max_side_px);
    if (width > side || height > side || static_cast<std::size_t>(width) * height > limits.max_pixels)
        fail_parse(source, place_of_byte(16), std::to_string(width) + " x " + std::to_string(height) + " pixels",
                   "at most " + std::to_string(limits.max_side_px) + " on a side and " +
                       std::to_string(limits.max_pixels) + " in all");
}

void read_info(const PngSource& file, std::string_view source, const ImageLimits& limits) {
    png_set_user_limits(file.png(), 0x7FFFFFFF, 0x7FFFFFFF);
    png_read_info(file.png(), file.info());
    check_size(png_get_image_width(file.png(), file.info()), png_get_image_height(file.png(), file.info()), source,
               limits);
}

/// All rows at once, as interlacing asks for.
std::vector<std::uint8_t> read_rows(const PngSource& file, std::size_t height) {
    if (png_set_interlace_handling(file.png()) < 1) throw SolverFailure("png: no interlace passes");
    png_read_update_info(file.png(), file.info());
    const std::size_t row_bytes = png_get_rowbytes(file.png(), file.info());
    std::vector<std::uint8_t> bytes(row_bytes * height);
    std::vector<png_bytep> rows(height);
    for (std::size_t y = 0; y < height; ++y) rows[y] = bytes.data() + y * row_bytes;
    png_read_image(file.png(), rows.data());
    png_read_end(file.png(), nullptr);
    return bytes;
}

}  // namespace

Image read_png(std::string_view bytes, std::string_view source, const ImageLimits& limits) {
    const PngSource file(bytes, source);
    read_info(file, source, limits);
    const png_structp png = file.png();
    Image image;
    image.width = static_cast<int>(png_get_image_width(png, file.info()));
    image.height = static_cast<int>(png_get_image_height(png, file.info()));
    image.has_alpha = (png_get_color_type(png, file.info()) & PNG_COLOR_MASK_ALPHA) != 0 ||
                      png_get_valid(png, file.info(), PNG_INFO_tRNS) != 0;
    png_set_alpha_mode(png, PNG_ALPHA_PNG, PNG_DEFAULT_sRGB);
    png_set_expand(png);
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 0xFF, PNG_FILLER_AFTER);
    const std::vector<std::uint8_t> rows = read_rows(file, static_cast<std::size_t>(image.height));
    image.pixels.resize(rows.size() / 4);
    std::memcpy(image.pixels.data(), rows.data(), rows.size());
    return image;
}

RawPng read_raw_png(std::string_view bytes, std::string_view source, const ImageLimits& limits) {
    const PngSource file(bytes, source);
    read_info(file, source, limits);
    const png_structp png = file.png();
    png_set_expand(png);
    RawPng raw;
    raw.width = static_cast<int>(png_get_image_width(png, file.info()));
    raw.height = static_cast<int>(png_get_image_height(png, file.info()));
    const std::vector<std::uint8_t> rows = read_rows(file, static_cast<std::size_t>(raw.height));
    raw.channels = png_get_channels(png, file.info());
    raw.bits = png_get_bit_depth(png, file.info());
    raw.samples.resize(static_cast<std::size_t>(raw.width) * static_cast<std::size_t>(raw.height) *
                       static_cast<std::size_t>(raw.channels));
    for (std::size_t i = 0; i < raw.samples.size(); ++i)
        raw.samples[i] =
            raw.bits == 16 ? static_cast<std::uint16_t>(rows[2 * i] << 8 | rows[2 * i + 1]) : std::uint16_t{rows[i]};
    return raw;
}

}  // namespace fretwork
