// Small readers of the importer: zip archives, deflated data, and spectra.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderlib/import/files/inflate.h"
#include "renderlib/import/files/zip_archive.h"
#include "renderlib/import/spectrum/spectrum.h"

namespace bandsaw {
namespace {

using ::testing::HasSubstr;

/// Returns the lowest `bytes` bytes of the number in little-endian order.
std::string little(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) {
    out.push_back(static_cast<char>(value >> (8 * i) & 0xff));
  }
  return out;
}

/// Returns an archive with one file, which is called `name`. The file holds "hello" without
/// compression. `attributes`: Unix mode in the upper 16 bits; `claimed`: the size of the file that
/// the archive claims; `entries`: how often the directory of the archive lists the file.
std::string archive(const std::string& name, std::uint32_t attributes = 0,
                    std::uint32_t claimed = 5, int entries = 1) {
  const std::string data = "hello";
  const std::uint32_t crc = 0x3610a686;
  std::string out = little(0x04034b50, 4) + little(20, 2) + little(0, 2) + little(0, 2) +
                    little(0, 4) + little(crc, 4) + little(claimed, 4) + little(claimed, 4) +
                    little(name.size(), 2) + little(0, 2) + name + data;
  const std::size_t directory = out.size();
  for (int i = 0; i < entries; ++i) {
    out += little(0x02014b50, 4) + little(3 << 8 | 20, 2) + little(20, 2) + little(0, 2) +
           little(0, 2) + little(0, 4) + little(crc, 4) + little(claimed, 4) + little(claimed, 4) +
           little(name.size(), 2) + little(0, 2) + little(0, 2) + little(0, 2) + little(0, 2) +
           little(attributes, 4) + little(0, 4) + name;
  }
  const std::size_t end = out.size();
  return out + little(0x06054b50, 4) + little(0, 2) + little(0, 2) +
         little(static_cast<std::uint64_t>(entries), 2) +
         little(static_cast<std::uint64_t>(entries), 2) + little(end - directory, 4) +
         little(directory, 4) + little(0, 2);
}

/// Opens the archive and reads its first file. Returns the message of the error, which is empty if
/// both succeed.
std::string error_of(const std::string& bytes) {
  const auto opened = ZipArchive::open(bytes);
  if (!opened.ok()) {
    return std::string(opened.status().message());
  }
  return std::string(opened->read(opened->entries().at(0)).status().message());
}

TEST(Zip, StoredFilesAreRead) {
  const std::string bytes = archive("a/b.txt");
  const auto opened = ZipArchive::open(bytes);
  ASSERT_TRUE(opened.ok()) << opened.status();
  ASSERT_EQ(opened->entries().size(), 1u);
  EXPECT_EQ(opened->entries()[0].name, "a/b.txt");
  const auto file = opened->read(opened->entries()[0]);
  ASSERT_TRUE(file.ok()) << file.status();
  EXPECT_EQ(*file, "hello");
}

TEST(Zip, NamesThatEscapeAreRefused) {
  for (const char* name : {"../a", "/a", "a/../../b", "a\\b", "a//b", "./a", "a\nb"}) {
    EXPECT_THAT(error_of(archive(name)), HasSubstr("not a path within it")) << name;
  }
  EXPECT_THAT(error_of(archive("link", 0xa1ffU << 16)), HasSubstr("symbolic link"));
}

TEST(Zip, DamageIsAnError) {
  EXPECT_THAT(error_of("PK"), HasSubstr("no directory"));
  EXPECT_THAT(error_of(archive("a", /*attributes=*/0, /*claimed=*/0xfffffff0)),
              HasSubstr("truncated"));
  EXPECT_THAT(error_of(archive("a", /*attributes=*/0, /*claimed=*/5, /*entries=*/2)),
              HasSubstr("two files"));
  std::string changed = archive("a");
  changed[32] ^= 1;  // the e of "hello"
  EXPECT_THAT(error_of(changed), HasSubstr("checksum"));
  const std::string whole = archive("abc");
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_NE(error_of(whole.substr(0, length)), "") << length;
  }
}

// The last argument of inflate() is the maximum size of the result.
TEST(Inflate, DamagedDataAndBombsAreErrors) {
  EXPECT_FALSE(inflate("\x1f\x8b\x08", DeflateKind::kGzip, 100).ok());
  EXPECT_FALSE(inflate("", DeflateKind::kRaw, 100).ok());
  // 706 zero bytes, deflated.
  const std::string zeros("\x63\x60\x18\x05\xa3\x60\x28\x03\x00", 9);
  const auto plain = inflate(zeros, DeflateKind::kRaw, 706);
  ASSERT_TRUE(plain.ok()) << plain.status();
  EXPECT_EQ(*plain, std::string(706, '\0'));
  EXPECT_EQ(inflate(zeros, DeflateKind::kRaw, 705).status().code(),
            absl::StatusCode::kResourceExhausted);
}

TEST(Spectrum, DaylightIsWhiteAndAConstantIsGrey) {
  const auto rgb = spectrum::light_rgb_of_luminance_1(*spectrum::named("stdillum-D65"));
  for (const double channel : rgb) {
    EXPECT_NEAR(channel, 1, 0.01);
  }
  for (const double channel : spectrum::factor_rgb({{500}, {0.25}})) {
    EXPECT_NEAR(channel, 0.25, 1e-9);
  }
}

// Illuminant A is defined as a black body of 2856 K. Its chromaticity is (0.44757, 0.40745).
TEST(Spectrum, ABlackBodyHasItsColour) {
  const auto rgb = spectrum::light_rgb(spectrum::blackbody(2856));
  const double x = 0.4124564 * rgb[0] + 0.3575761 * rgb[1] + 0.1804375 * rgb[2];
  const double y = 0.2126729 * rgb[0] + 0.7151522 * rgb[1] + 0.0721750 * rgb[2];
  const double z = 0.0193339 * rgb[0] + 0.1191920 * rgb[1] + 0.9503041 * rgb[2];
  EXPECT_NEAR(x / (x + y + z), 0.44757, 0.001);
  EXPECT_NEAR(y / (x + y + z), 0.40745, 0.001);
}

// The spectra have the names that they have in pbrt-v4. reflectance() is at normal incidence.
TEST(Spectrum, MetalsHaveTheirColours) {
  const auto reflectance = [](const std::string& name) {
    const auto metal = spectrum::metal_rgb(*spectrum::named("metal-" + name + "-eta"),
                                           *spectrum::named("metal-" + name + "-k"));
    std::array<double, 3> out = {};
    for (std::size_t c = 0; c < 3; ++c) {
      const double k2 = metal.k[c] * metal.k[c];
      out[c] = (std::pow(metal.eta[c] - 1, 2) + k2) / (std::pow(metal.eta[c] + 1, 2) + k2);
    }
    return out;
  };
  // The first two values are for brass (CuZn) at 500 nm, from the table of Querry. The next values
  // are for silver (Ag) at 551 nm, from the table of Palik, and for rutile (TiO2) at 589 nm.
  EXPECT_NEAR(spectrum::named("metal-CuZn-eta")->at(500), 0.686, 1e-3);
  EXPECT_NEAR(spectrum::named("metal-CuZn-k")->at(500), 2.250, 1e-3);
  EXPECT_NEAR(spectrum::named("metal-Ag-eta")->at(551), 0.125, 2e-3);
  EXPECT_NEAR(spectrum::named("metal-TiO2-eta")->at(589.3), 2.909, 2e-3);
  EXPECT_NEAR(spectrum::named("glass-F11")->at(604), 1.78228, 1e-4);
  EXPECT_GT(reflectance("Au")[0], 0.9);
  EXPECT_LT(reflectance("Au")[2], 0.5);
  EXPECT_GT(reflectance("Cu")[0], reflectance("Cu")[2] + 0.3);
  EXPECT_GT(reflectance("Ag")[2], 0.9);
  EXPECT_NEAR(spectrum::named("glass-BK7")->at(spectrum::kLineD), 1.5168, 0.0005);
}

TEST(Spectrum, WrongPairsAreErrors) {
  EXPECT_FALSE(spectrum::from_pairs({}).ok());
  EXPECT_FALSE(spectrum::from_pairs({400}).ok());
  EXPECT_FALSE(spectrum::from_pairs({400, 1, 400, 2}).ok());
  EXPECT_FALSE(spectrum::parse_spd("400 1\nx 2").ok());
  EXPECT_TRUE(spectrum::parse_spd("# lambda value\n400 1\n700 2\n").ok());
}

}  // namespace
}  // namespace bandsaw
