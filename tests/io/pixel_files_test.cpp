#include "evo/io/pixel_files.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <string>
#include <utility>
#include <vector>

#include "io/support.hpp"

namespace evo::io {
namespace {

constexpr int kWidth = 4;
constexpr int kHeight = 3;

void WriteImage(const std::filesystem::path& path, png_uint_32 format, const std::vector<std::uint8_t>& pixels,
                int width = kWidth, int height = kHeight) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = format;
  ASSERT_TRUE(png_image_write_to_file(&image, path.c_str(), 0, pixels.data(), 0, nullptr));
}

class PixelFiles : public IoTest {
 protected:
  const std::filesystem::path path_ = folder / "file";
};

TEST_F(PixelFiles, BlackOfAGreyMaskIsIgnored) {
  WriteImage(path_, PNG_FORMAT_GRAY, {0, 255, 255, 255, 0, 0, 1, 255, 255, 255, 255, 0});
  EXPECT_EQ(ReadMask(path_, kWidth, kHeight), (std::vector<std::uint8_t>{1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 1}));
}

TEST_F(PixelFiles, BlackOfAColourMaskIsIgnored) {
  std::vector<std::uint8_t> rgb(3 * kWidth * kHeight, 0);
  rgb[3 * 5 + 2] = 200;  // blue
  WriteImage(path_, PNG_FORMAT_RGB, rgb);
  const auto ignored = ReadMask(path_, kWidth, kHeight);
  for (std::size_t i = 0; i < ignored.size(); ++i) EXPECT_EQ(ignored[i], i == 5 ? 0 : 1);
}

TEST_F(PixelFiles, TransparentPixelsAreIgnored) {
  std::vector<std::uint8_t> rgba(4 * kWidth * kHeight, 255);
  rgba[4 * 7 + 3] = 0;
  WriteImage(path_, PNG_FORMAT_RGBA, rgba);
  const auto ignored = ReadMask(path_, kWidth, kHeight);
  for (std::size_t i = 0; i < ignored.size(); ++i) EXPECT_EQ(ignored[i], i == 7 ? 1 : 0);
}

TEST_F(PixelFiles, MaskErrorsSayWhatIsWrong) {
  const auto read = [&] { ReadMask(path_, kWidth, kHeight); };
  ExpectMentions(Refusal(read), {"file"});
  WriteImage(path_, PNG_FORMAT_GRAY, std::vector<std::uint8_t>(20, 255), 5, 4);
  ExpectMentions(Refusal(read), {"5 x 4 px, the sensor 4 x 3"});
  WriteImage(path_, PNG_FORMAT_GRAY, std::vector<std::uint8_t>(12, 0));
  ExpectMentions(Refusal(read), {"black everywhere"});
  WriteImage(path_, PNG_FORMAT_GRAY, std::vector<std::uint8_t>(12, 255));
  std::filesystem::resize_file(path_, 50);
  ExpectMentions(Refusal(read), {"cannot be read as PNG"});
  Write("file", "no image\n");
  ExpectMentions(Refusal(read), {"cannot be read as PNG", "give a whole PNG image"});
}

TEST_F(PixelFiles, HotPixelsAreReadBack) {
  WriteHotPixels(path_, std::vector<events::HotPixel>{{3, 2, 0, 1'000'000'000, 101}, {1, 2, 0, 0, 0}, {2, 0, 5, 5, 1}});
  EXPECT_EQ(Content(path_), "# x y rate_hz\n2 0 0.0\n1 2 0.0\n3 2 100.0\n");
  EXPECT_EQ(ReadHotPixels(path_, kWidth, kHeight), (std::vector<std::uint32_t>{2, 9, 11}));
}

TEST_F(PixelFiles, HotPixelErrorsNameTheLine) {
  const std::vector<std::pair<std::string, std::string>> faults = {{"1 1\n4 0\n", ":2: the column '4'"},
                                                                   {"1 3\n", ":1: the row '3'"},
                                                                   {"1 -1\n", "the row '-1'"},
                                                                   {"# x y\n1\n", ":2: expected 'x y'"},
                                                                   {"a 1\n", "the column 'a'"}};
  for (const auto& [text, what] : faults) {
    Write("file", text);
    ExpectMentions(Refusal([&] { ReadHotPixels(path_, kWidth, kHeight); }), {what});
  }
}

}  // namespace
}  // namespace evo::io
