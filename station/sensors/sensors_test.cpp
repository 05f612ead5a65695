#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "station/sensors/igtl.hpp"
#include "station/sensors/motion_rows.hpp"
#include "station/sensors/netft.hpp"
#include "station/sensors/row_file.hpp"

namespace tractus {
namespace sensors {
namespace {
using math::Vec3;

const char* const kPage =
    "<?xml version=\"1.0\"?><netft><calsn>FT1234</calsn><cfgcpf>1000000</cfgcpf>"
    "<cfgcpt>500000</cfgcpt><scfgfu>N</scfgfu><scfgtu>Nm</scfgtu><comrdtrate>7000</comrdtrate></"
    "netft>";

TEST(NetFt, ReadsItsCalibrationInAnyUnitThatItUses) {
  const auto si = parse_netft_xml(kPage, "page");
  ASSERT_TRUE(si) << si.error().what;
  EXPECT_EQ(si->counts_per_N, 1e6);
  EXPECT_EQ(si->counts_per_Nm, 5e5);
  EXPECT_EQ(si->rate_Hz, 7000);
  EXPECT_EQ(si->serial, "FT1234");
  std::string pounds = kPage;
  pounds.replace(pounds.find(">N<"), 3, ">lbf<");
  pounds.replace(pounds.find(">Nm<"), 4, ">lbf-in<");
  const auto us = parse_netft_xml(pounds, "page");
  ASSERT_TRUE(us);
  EXPECT_NEAR(us->counts_per_N, 1e6 / 4.4482216152605, 1e-3);      // 1 lbf = 4.44822… N
  EXPECT_NEAR(us->counts_per_Nm, 5e5 / 0.1129848290276167, 1e-2);  // 1 lbf·in = 0.112985 N·m
  std::string grams = kPage;
  grams.replace(grams.find(">N<"), 3, ">gf<");
  EXPECT_NEAR(parse_netft_xml(grams, "page")->counts_per_N, 1e6 / 0.00980665, 1e-3);
}

TEST(NetFt, NamesWhatAPageLacks) {
  std::string page = kPage;
  page.erase(page.find("<cfgcpt>"), 23);
  const auto none = parse_netft_xml(page, "http://sensor/netftapi2.xml");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().what.find("cfgcpt"), std::string::npos);
  std::string odd = kPage;
  odd.replace(odd.find(">N<"), 3, ">stone<");
  EXPECT_NE(parse_netft_xml(odd, "p").error().what.find("stone"), std::string::npos);
  EXPECT_FALSE(parse_netft_xml("", "p"));
  EXPECT_FALSE(parse_netft_xml("<cfgcpf>-1</cfgcpf>", "p"));
}

TEST(NetFt, ReadsARecordAsDocumented) {
  // Sequence 5, sample 70, status 0, then 1, -2, 3 N and 0.1, 0, -0.1 N·m in counts.
  const std::array<std::int32_t, 9> words{5,         70,     0, 1'000'000, -2'000'000,
                                          3'000'000, 50'000, 0, -50'000};
  std::vector<std::byte> bytes;
  for (const std::int32_t w : words)
    for (int k = 3; k >= 0; --k) bytes.push_back(std::byte(std::uint32_t(w) >> (8 * k)));
  const auto record = parse_rdt(bytes);
  ASSERT_TRUE(record);
  EXPECT_EQ(record->sequence, 5u);
  EXPECT_EQ(record->ft_sequence, 70u);
  const auto wrench = wrench_of(*record, *parse_netft_xml(kPage, "p"));
  EXPECT_LT((wrench.force_N - Vec3(1, -2, 3)).norm(), 1e-12);
  EXPECT_LT((wrench.torque_Nm - Vec3(0.1, 0, -0.1)).norm(), 1e-12);
  bytes.pop_back();
  EXPECT_FALSE(parse_rdt(bytes));
}

TEST(NetFt, SaysWhatAnAxiasStatusMeans) {
  constexpr auto kAxia = NetFtStatus::axia;
  EXPECT_FALSE(is_faulty(0));
  EXPECT_FALSE(is_faulty(0x00010000));  // a threshold is no error
  EXPECT_TRUE(is_faulty(0x80000020));
  EXPECT_FALSE(is_saturated(0x80000020, kAxia));
  // "30 F/T out of range 0xC0000000", "27 Gage out of range 0x88000000" (9610-05, table 4.9)
  EXPECT_TRUE(is_saturated(0xC0000000, kAxia));
  EXPECT_TRUE(is_saturated(0x88000000, kAxia));
  EXPECT_EQ(status_words(0xC0000000, kAxia), "0xc0000000 (force or torque out of range)");
  EXPECT_EQ(status_words(0x80000005, kAxia),
            "0x80000005 (inner temperature out of range, a gage is broken)");
  EXPECT_EQ(status_words(0x80000000, kAxia), "0x80000000 (an error)");
  EXPECT_EQ(status_words(0, kAxia), "0x00000000 (no error)");
}

// Bits as public drivers of the Net F/T name them: 16 "monitor condition latched", for which bit 31
// is up too, 17 "transducer saturation or A/D error", 27 "serial link communication error".
TEST(NetFt, SaysWhatABoxsStatusMeansWhichHasOtherBits) {
  constexpr auto kBox = NetFtStatus::box;
  EXPECT_FALSE(is_faulty(0x80010000));  // a threshold of the user's: the sample is good
  EXPECT_TRUE(is_faulty(0x80020000));
  EXPECT_TRUE(is_faulty(0x80030000));
  EXPECT_TRUE(is_saturated(0x80020000, kBox));
  EXPECT_FALSE(is_saturated(0x88000000, kBox));
  EXPECT_FALSE(is_saturated(0xC0000000, kBox));
  EXPECT_NE(status_words(0x80020000, kBox).find("saturated"), std::string::npos);
  EXPECT_EQ(status_words(0x88000000, kBox), "0x88000000 (the serial link failed)");
}

TEST(NetFt, KnowsAnAxiaFromABoxByItsPage) {
  EXPECT_EQ(parse_netft_xml(kPage, "p")->status, NetFtStatus::box);
  std::string page = kPage;
  page.insert(page.find("<cfgcpf>"), "<prodname>Ethernet Axia</prodname>");
  const auto axia = parse_netft_xml(page, "p");
  EXPECT_EQ(axia->status, NetFtStatus::axia);
  EXPECT_EQ(axia->product, "Ethernet Axia");
  std::string nameless = kPage;  // "setrate" is in the Axia's table of elements alone
  nameless.insert(nameless.find("<cfgcpf>"), "<setrate>0</setrate>");
  EXPECT_EQ(parse_netft_xml(nameless, "p")->status, NetFtStatus::axia);
}

// Of a Gamma SI-330-30 with firmware 2.2.59, as a public driver's tests have the page, shortened.
TEST(NetFt, ReadsTheCalibrationsSerialNumberOfARealBoxsPage) {
  const auto page = parse_netft_xml(
      "<?xml version=\"1.0\"?><netft>\n<runstat>0x00000000</runstat><runrate>7000</runrate>\n"
      "<cfgnam>empty</cfgnam><cfgcalsel>0</cfgcalsel><cfgcalsn>FT27462</cfgcalsn>\n"
      "<scfgfu>N</scfgfu><scfgtu>Nm</scfgtu>\n<cfgcpf>1000000</cfgcpf><cfgcpt>1000000</cfgcpt>\n"
      "<comrdte>Enabled</comrdte><comrdtrate>100</comrdtrate><comrdtbsiz>1</comrdtbsiz>\n</netft>",
      "p");
  ASSERT_TRUE(page) << page.error().what;
  EXPECT_EQ(page->serial, "FT27462");
  EXPECT_EQ(page->rate_Hz, 100.0);
  EXPECT_EQ(page->status, NetFtStatus::box);
}

TEST(NetFt, RefusesAPageThatSaysThatRdtIsOff) {
  std::string page = kPage;
  page.insert(page.find("<comrdtrate>"), "<comrdte>Disabled</comrdte>");
  const auto off = parse_netft_xml(page, "p");
  ASSERT_FALSE(off);
  EXPECT_NE(off.error().what.find("switched off"), std::string::npos);
}

TEST(Igtl, HasTheStandardsCrc) {
  // CRC-64/ECMA-182 of "123456789", the check value of the catalogue of parametrised CRCs.
  EXPECT_EQ(crc64(core::bytes_of("123456789")), 0x6c40df5f0b497347ull);
}

/// A message by hand, big-endian.
std::vector<std::byte> message(const std::string& type, const std::string& device,
                               const std::vector<std::byte>& body) {
  std::vector<std::byte> out(kIgtlHeaderBytes);
  out[1] = std::byte{1};
  std::memcpy(&out[2], type.data(), type.size());
  std::memcpy(&out[14], device.data(), device.size());
  out[37] = std::byte{100};   // 100 s
  out[38] = std::byte{0x80};  // and a half
  out[48] = std::byte(body.size() >> 8), out[49] = std::byte(body.size());
  const std::uint64_t crc = crc64(body);
  for (std::size_t k = 0; k < 8; ++k) out[50 + k] = std::byte(crc >> (56 - 8 * k));
  out.insert(out.end(), body.begin(), body.end());
  return out;
}

void put(std::vector<std::byte>& out, float value) {
  std::uint32_t word = 0;
  std::memcpy(&word, &value, 4);
  for (int k = 3; k >= 0; --k) out.push_back(std::byte(word >> (8 * k)));
}

/// A quarter turn about z by columns, and 10, 20, 30 mm.
std::vector<std::byte> matrix() {
  std::vector<std::byte> out;
  for (const float v : {0.f, 1.f, 0.f, -1.f, 0.f, 0.f, 0.f, 0.f, 1.f, 10.f, 20.f, 30.f})
    put(out, v);
  return out;
}

TEST(Igtl, ReadsATransformAndATdataMessage) {
  const auto one = message("TRANSFORM", "probe", matrix());
  const auto header = parse_igtl_header(one);
  ASSERT_TRUE(header);
  EXPECT_EQ(header->stamp_s, 100.5);
  EXPECT_EQ(header->body_bytes, 48u);
  const auto body = std::span(one).subspan(kIgtlHeaderBytes);
  EXPECT_EQ(header->crc, crc64(body));
  const auto poses = parse_igtl_body(*header, body);
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].body, "probe");
  EXPECT_LT((poses[0].X_CB.p - Vec3(0.01, 0.02, 0.03)).norm(), 1e-9);
  EXPECT_LT((poses[0].X_CB.q * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-6);

  std::vector<std::byte> elements;
  for (const std::string name : {"probe", "bone"}) {
    std::vector<std::byte> element(22);
    std::memcpy(element.data(), name.data(), name.size());
    const auto m = matrix();
    element.insert(element.end(), m.begin(), m.end());
    elements.insert(elements.end(), element.begin(), element.end());
  }
  const auto two = message("TDATA", "tracker", elements);
  const auto both =
      parse_igtl_body(*parse_igtl_header(two), std::span(two).subspan(kIgtlHeaderBytes));
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[1].body, "bone");
}

TEST(Igtl, ReadsQuaternionsOfAQtdataMessage) {
  std::vector<std::byte> element(22);
  std::memcpy(element.data(), "probe", 5);
  const float half = std::sqrt(0.5f);
  for (const float v : {10.f, 20.f, 30.f, 0.f, 0.f, half, half}) put(element, v);  // x y z w
  const auto one = message("QTDATA", "tracker", element);
  const auto poses = parse_igtl_body(*parse_igtl_header(one), std::span(one).subspan(58));
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].body, "probe");
  EXPECT_LT((poses[0].X_CB.p - Vec3(0.01, 0.02, 0.03)).norm(), 1e-9);
  EXPECT_LT((poses[0].X_CB.q * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-6);
}

TEST(Igtl, ReadsWhatLiesBetweenAnExtendedHeaderAndMetadata) {
  std::vector<std::byte> body(12);  // version 3 of the protocol, 2 of the header
  body[1] = std::byte{12};          // its own size
  body[3] = std::byte{2};           // of the metadata's header
  body[7] = std::byte{5};           // of the metadata
  const auto m = matrix();
  body.insert(body.end(), m.begin(), m.end());
  body.resize(body.size() + 7);
  auto one = message("TRANSFORM", "probe", body);
  one[1] = std::byte{2};
  const auto poses = parse_igtl_body(*parse_igtl_header(one), std::span(one).subspan(58));
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_LT((poses[0].X_CB.p - Vec3(0.01, 0.02, 0.03)).norm(), 1e-9);
}

TEST(Igtl, ReadsWhatASenderSaysOfItself) {
  std::vector<std::byte> body(30);
  body[1] = std::byte{6};
  std::memcpy(&body[10], "Busy", 4);
  for (const char c : std::string("calibrating\n")) body.push_back(std::byte(c));
  const auto one = message("STATUS", "tracker", body);
  const auto status = parse_igtl_status(*parse_igtl_header(one), std::span(one).subspan(58));
  ASSERT_TRUE(status);
  EXPECT_EQ(status->code, 6);
  EXPECT_EQ(status->name, "Busy");
  EXPECT_EQ(status->message, "calibrating?");  // one line, whatever was sent
  EXPECT_FALSE(parse_igtl_status(*parse_igtl_header(one), std::span(one).subspan(58, 29)));
}

/// The head of a message of so many bytes.
std::vector<std::byte> head(const std::string& type, std::uint64_t bytes) {
  auto out = message(type, "it", {});
  for (std::size_t k = 0; k < 8; ++k) out[42 + k] = std::byte(bytes >> (56 - 8 * k));
  return out;
}

// A server of ultrasound or video sends its pictures to everybody: 1920 × 1080 in three colours.
TEST(IgtlReader, PassesOverALongPictureBetweenTwoPoses) {
  constexpr std::size_t kPicture = 1920 * 1080 * 3 + 72;
  auto bytes = message("TRANSFORM", "probe", matrix());
  const auto picture = head("IMAGE", kPicture), after = message("TRANSFORM", "bone", matrix());
  bytes.insert(bytes.end(), picture.begin(), picture.end());
  bytes.resize(bytes.size() + kPicture, std::byte{0x5a});
  bytes.insert(bytes.end(), after.begin(), after.end());
  for (const std::size_t piece : {std::size_t{1}, std::size_t{57}, std::size_t{65536}}) {
    IgtlReader reader;
    std::vector<std::string> seen;
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      reader.add(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)));
      for (;;) {
        const auto next = reader.next();
        ASSERT_TRUE(next) << next.error().what;
        if (!*next) break;
        for (const TrackedPose& pose : **next) seen.push_back(pose.body);
      }
      ASSERT_LE(reader.held(), kIgtlHeaderBytes + 48 + piece);
    }
    EXPECT_EQ(seen, (std::vector<std::string>{"probe", "bone"})) << piece;
  }
}

TEST(IgtlReader, RefusesWhatIsNoOpenIgtlink) {
  const auto refused = [](const std::vector<std::byte>& bytes) {
    IgtlReader reader;
    reader.add(bytes);
    return !reader.next();
  };
  EXPECT_TRUE(refused(head("TDATA", kIgtlMostBytes + 1)));
  EXPECT_TRUE(refused(head("IMAGE", ~std::uint64_t{0})));
  auto other = head("TDATA", 0);
  other[0] = std::byte{'H'}, other[1] = std::byte{'T'};  // "HTTP/1.1 …"
  EXPECT_TRUE(refused(other));
}

TEST(IgtlReader, CountsADamagedMessageAndReadsTheNext) {
  auto bytes = message("TRANSFORM", "probe", matrix());
  bytes.back() ^= std::byte{1};
  const auto after = message("TRANSFORM", "bone", matrix());
  bytes.insert(bytes.end(), after.begin(), after.end());
  IgtlReader reader;
  reader.add(bytes);
  EXPECT_TRUE((*reader.next())->empty());
  EXPECT_EQ(reader.damaged(), 1u);
  EXPECT_EQ((*reader.next())->at(0).body, "bone");
}

// "Version 3: Header (58) + ExtHdrSize (2) + ExtHdr + Content": some senders write 3 there.
TEST(Igtl, TakesAHeaderOfVersion3AsOneOf2) {
  std::vector<std::byte> body(12);
  body[1] = std::byte{12};
  const auto m = matrix();
  body.insert(body.end(), m.begin(), m.end());
  auto one = message("TRANSFORM", "probe", body);
  one[1] = std::byte{3};
  ASSERT_TRUE(parse_igtl_header(one));
  EXPECT_EQ(parse_igtl_body(*parse_igtl_header(one), std::span(one).subspan(58)).size(), 1u);
  one[1] = std::byte{4};
  EXPECT_FALSE(parse_igtl_header(one));
}

TEST(MotionRows, KnowHowOftenEachBodyWasSeenAndWhichNever) {
  MotionRows rows({"probe", "bone", "pelvis"});
  EXPECT_FALSE(rows.take({"probe", {}, 500.0}, 7.0));
  EXPECT_EQ(rows.missing(), (std::vector<std::string>{"bone", "pelvis"}));
  EXPECT_FALSE(rows.take({"bone", {}, 500.0}, 7.0));
  EXPECT_TRUE(rows.take({"probe", {}, 500.5}, 7.5));
  EXPECT_TRUE(rows.flush());
  EXPECT_EQ(rows.missing(), (std::vector<std::string>{"pelvis"}));
  EXPECT_EQ(rows.seen(),
            (std::map<std::string, std::uint64_t>{{"bone", 1}, {"pelvis", 0}, {"probe", 2}}));
}

TEST(MotionRows, MakeOneRowOfAnInstant) {
  MotionRows rows({"probe", "bone"});
  const math::Pose X{{1, 2, 3}, math::Quat::Identity()};
  EXPECT_FALSE(rows.take({"probe", X, 500.0}, 7.0));
  EXPECT_FALSE(rows.take({"bone", X, 500.0}, 7.001));
  EXPECT_FALSE(rows.take({"pointer", X, 500.0}, 7.001));
  const auto first = rows.take({"probe", X, 500.25}, 7.25);
  ASSERT_TRUE(first);
  EXPECT_EQ(*first, "0.0000000,1,2,3,1,0,0,0,1,2,3,1,0,0,0,7.0000000\n");
  const auto second = rows.flush();
  ASSERT_TRUE(second);
  EXPECT_EQ(*second, "0.2500000,1,2,3,1,0,0,0,0,0,0,0,0,0,0,7.2500000\n");  // bone: not seen
  EXPECT_EQ(rows.count(), 2u);
  EXPECT_TRUE(rows.others().contains("pointer"));
}

TEST(MotionRows, TakeThisComputersTimeWhereNobodyStamps) {
  MotionRows rows({"probe"});
  EXPECT_FALSE(rows.take({"probe", {}, 0.0}, 1.5));
  const auto row = rows.take({"probe", {}, 0.0}, 1.625);
  ASSERT_TRUE(row);
  EXPECT_TRUE(row->starts_with("1.5000000,"));
}

class Rows : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  std::filesystem::path path_ = std::filesystem::temp_directory_path() / core::new_id();
  std::string there() const {
    const auto bytes = core::read_file(path_);
    return bytes ? std::string(core::text_of(*bytes)) : "";
  }
};

TEST_F(Rows, AreInTheFileAfterHalfASecondAndAlwaysWhole) {
  auto file = RowFile::make(path_, "t_s\n");
  ASSERT_TRUE(file) << file.error().what;
  EXPECT_EQ(there(), "t_s\n");
  file->add("1\n", 1'000'000'000);
  EXPECT_EQ(there(), "t_s\n1\n");
  file->add("2\n", 1'300'000'000);
  file->add("3\n", 1'400'000'000);
  EXPECT_EQ(there(), "t_s\n1\n");
  file->add("4\n", 1'500'000'000);
  EXPECT_EQ(there(), "t_s\n1\n2\n3\n4\n");
  file->add("5\n", 1'600'000'000);
  EXPECT_TRUE(file->finish());
  EXPECT_EQ(there(), "t_s\n1\n2\n3\n4\n5\n");
  EXPECT_FALSE(RowFile::make(path_, "t_s\n"));  // nothing is overwritten
}

TEST_F(Rows, EndWithAWholeOneWhenTheDiskTakesNoMore) {
  // A file may grow to 25 bytes here: two rows of ten and a half.
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  auto file = RowFile::make(path_, "t_s,fx_N_\n");
  ASSERT_TRUE(file);
  const rlimit small{.rlim_cur = 25, .rlim_max = before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  file->add("1,1234567\n2,1234567\n3,1234567\n", 1'000'000'000);
  const auto finished = file->finish();
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_TRUE(file->failed());
  ASSERT_FALSE(finished);
  EXPECT_NE(finished.error().what.find("File too large"), std::string::npos);
  EXPECT_EQ(there(), "t_s,fx_N_\n1,1234567\n");
}

TEST(Igtl, GivesNothingForWhatIsCutOrNoTurnOrAnotherType) {
  auto flat = matrix();
  for (std::size_t k = 0; k < 36; ++k) flat[k] = std::byte{0};
  const auto one = message("TRANSFORM", "probe", flat);
  EXPECT_TRUE(parse_igtl_body(*parse_igtl_header(one), std::span(one).subspan(58)).empty());
  const auto image = message("IMAGE", "x", matrix());
  EXPECT_TRUE(parse_igtl_body(*parse_igtl_header(image), std::span(image).subspan(58)).empty());
  EXPECT_TRUE(parse_igtl_body(*parse_igtl_header(one), std::span(one).subspan(58, 20)).empty());
  EXPECT_FALSE(parse_igtl_header(std::span(one).first(57)));
  auto odd = one;
  odd[0] = std::byte{9};
  EXPECT_FALSE(parse_igtl_header(odd));
}

}  // namespace
}  // namespace sensors
}  // namespace tractus
