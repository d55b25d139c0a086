#include "support/coded_pictures.h"

#include <cstddef>
#include <cstdio>
#include <cstdlib>
// jpeglib.h needs the headers above.
#include <jpeglib.h>
#include <png.h>

namespace fretwork::testing {
namespace {

std::size_t channels_of(int color_type) {
    return color_type == PNG_COLOR_TYPE_RGB          ? 3
           : color_type == PNG_COLOR_TYPE_RGB_ALPHA  ? 4
           : color_type == PNG_COLOR_TYPE_GRAY_ALPHA ? 2
                                                     : 1;
}

void append_bytes(png_structp png, png_bytep bytes, std::size_t size) {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), size);
}

}  // namespace

std::string make_png(int width, int height, const PngKind& kind, const std::vector<std::uint16_t>& samples) {
    std::string out;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &out, append_bytes, nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), kind.bits,
                 kind.color_type, kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (kind.color_type == PNG_COLOR_TYPE_PALETTE) {
        png_color palette[16];
        png_byte alpha[16];
        const int entries = 1 << (kind.bits > 4 ? 4 : kind.bits);
        for (int i = 0; i < entries; ++i) {
            palette[i] = {static_cast<png_byte>(i), static_cast<png_byte>(2 * i), static_cast<png_byte>(3 * i)};
            alpha[i] = static_cast<png_byte>(255 - i);
        }
        png_set_PLTE(png, info, palette, entries);
        png_set_tRNS(png, info, alpha, entries, nullptr);
    }
    if (kind.transparent_grey >= 0) {
        png_color_16 color{};
        color.gray = static_cast<png_uint_16>(kind.transparent_grey);
        png_set_tRNS(png, info, nullptr, 1, &color);
    }
    if (kind.gamma > 0.0) png_set_gAMA(png, info, kind.gamma);
    png_write_info(png, info);
    if (kind.bits < 8) png_set_packing(png);

    const std::size_t per_row = static_cast<std::size_t>(width) * channels_of(kind.color_type);
    const std::size_t bytes = kind.bits == 16 ? 2 : 1;
    std::vector<png_byte> pixels(per_row * bytes * static_cast<std::size_t>(height));
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (bytes == 2) pixels[2 * i] = static_cast<png_byte>(samples[i] >> 8);
        pixels[bytes * i + bytes - 1] = static_cast<png_byte>(samples[i] & 0xFF);
    }
    std::vector<png_bytep> rows;
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) rows.push_back(&pixels[y * per_row * bytes]);
    png_write_image(png, rows.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return out;
}

std::string make_jpeg(int width, int height, JpegKind kind, const std::vector<std::uint8_t>& samples, int orientation) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* memory = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &memory, &size);
    const bool inks = kind == JpegKind::kCmykAdobe || kind == JpegKind::kCmykPlain || kind == JpegKind::kYcck;
    jpeg.image_width = static_cast<JDIMENSION>(width);
    jpeg.image_height = static_cast<JDIMENSION>(height);
    jpeg.input_components = inks ? 4 : kind == JpegKind::kGrey ? 1 : 3;
    jpeg.in_color_space = inks ? JCS_CMYK : kind == JpegKind::kGrey ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&jpeg);
    if (kind == JpegKind::kYcck) jpeg_set_colorspace(&jpeg, JCS_YCCK);
    if (kind == JpegKind::kCmykPlain) jpeg.write_Adobe_marker = FALSE;
    jpeg_set_quality(&jpeg, 100, TRUE);
    for (int c = 0; c < jpeg.num_components; ++c) jpeg.comp_info[c].h_samp_factor = jpeg.comp_info[c].v_samp_factor = 1;
    if (kind == JpegKind::kProgressive) jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    if (orientation > 0) {
        std::string exif("Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0", 24);
        exif += static_cast<char>(orientation);
        exif.append(7, '\0');
        jpeg_write_marker(&jpeg, JPEG_APP0 + 1, reinterpret_cast<const JOCTET*>(exif.data()),
                          static_cast<unsigned>(exif.size()));
    }
    std::vector<std::uint8_t> pixels = samples;
    const std::size_t per_row = static_cast<std::size_t>(width) * static_cast<std::size_t>(jpeg.input_components);
    while (jpeg.next_scanline < jpeg.image_height) {
        JSAMPROW row = &pixels[jpeg.next_scanline * per_row];
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    std::string out(reinterpret_cast<const char*>(memory), size);
    jpeg_destroy_compress(&jpeg);
    std::free(memory);
    return out;
}

}  // namespace fretwork::testing
