/// From a released volume to a case that stations take: what is told before, what is made, by whom.
#include <cmath>

#include "core/try.hpp"
#include "db/store/cases/case_makings.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/volumes/volumes.hpp"
#include "server/api/people/people_test_support.hpp"
#include "server/jobs/case_facts.hpp"
#include "server/jobs/certify_case.hpp"
#include "server/jobs/make_case.hpp"
#include "server/jobs/publish.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace api {
namespace {
using testing::PeopleTest;
using volume::Vec3;

/// A made vertebra, mirrored about x = 0: two hollow pedicles with walls of 2 mm, 17 mm from the
/// midline, whose insides are 3 mm to a side of the middle; a body with a shell; a spine.
double made_vertebra(const Vec3& p_m) {
  const Vec3 p = p_m * 1e3;
  const double u = std::abs(p.x()), off = std::abs(u - 17), z = std::abs(p.z());
  const double body = std::hypot(u / 25, (p.y() + 22) / 17);
  const bool in_body = body < 1 && z < 13,
             marrow = std::hypot(u / 23, (p.y() + 22) / 15) < 1 && z < 11;
  const bool pedicle = off < 5 && z < 7 && p.y() > -14 && p.y() < 22;
  const bool core = off < 3 && z < 5 && p.y() > -16 && p.y() < 20;
  const bool spine = u < 3 && p.y() > 16 && p.y() < 40 && z < 8;
  if (core || (marrow && !pedicle)) return 60;
  return in_body || pedicle || spine ? 900 : 20;
}

class CaseMaking : public PeopleTest {
 protected:
  CaseMaking() {
    volume::Volume v{.geometry = {{80, 90, 44},
                                  Vec3::Constant(0.001),
                                  Vec3(-0.0395, -0.0445, -0.0215),
                                  volume::Mat3::Identity()},
                     .slope = 1,
                     .intercept = -1024,
                     .counts = {}};
    for (int k = 0; k < 44; ++k)
      for (int j = 0; j < 90; ++j)
        for (int i = 0; i < 80; ++i)
          v.counts.push_back(v.count_of(made_vertebra(v.geometry.position_of(Vec3(i, j, k)))));
    const auto path = folder_.path() / "ct.tvol";
    EXPECT_TRUE(volume::write_volume(path, v, {"made", ""}));
    sha_ = store::file_sha256(path).value();
    EXPECT_TRUE(objects_.copy_in(path, sha_));
    add_volume("released", store::VolumeState::released);
  }
  void add_volume(const std::string& id, store::VolumeState state) {
    store::VolumeRecord record;
    record.id = record.name = id;
    record.source = "made for a test";
    record.state = state;
    record.sha256 = id == "released" ? sha_ : core::sha256(core::bytes_of(id));
    record.made_by = record.made_by_id = "ann";
    const auto added = store_.write([&](store::Writing& tx) -> core::Result<void> {
      TRY(store::add_object(tx, record.sha256, 1, 1));
      return store::add_volume(tx, record);
    });
    EXPECT_TRUE(added) << added.error().what;
  }
  static core::Json plan(core::Json more = core::Json::object()) {
    core::Json out{{"entry_m", {0.017, 0.024, 0.0}},
                   {"target_m", {0.017, -0.016, 0.0}},
                   {"breach", {{"wall", "medial"}, {"depth_m", 0.003}}}};
    out.update(more);
    return out;
  }
  core::Json look(const core::Json& wish) {
    const auto seen = post("fay", "/volumes/released/tract", wish);
    EXPECT_EQ(seen.status, 200) << text(seen);
    return json(seen);
  }
  /// Asks for a case and does the job at once.
  std::string made(const core::Json& wish) {
    const auto asked = post("fay", "/cases", wish);
    EXPECT_EQ(asked.status, 201) << text(asked);
    const std::string id = json(asked).value("id", "");
    const auto done =
        jobs::make_case(store_, objects_, backend_.secrets.case_key(), id, [] { return false; });
    EXPECT_TRUE(done) << done.error().what;
    return json(get("fay", "/case-makings/" + id)).value("case_id", "");
  }
  std::string sha_;
};

TEST_F(CaseMaking, APlanIsToldItsWallsItsBreachAndItsSide) {
  const core::Json found = look(plan());
  EXPECT_EQ(found["problems"], core::Json::array());
  EXPECT_EQ(found["side"], "left") << "x grows to the patient's left";
  EXPECT_NEAR(found["length_m"].get<double>(), 0.040, 1e-12);
  ASSERT_EQ(found["walls"].size(), 5u);
  const core::Json& medial = found["walls"][0];
  EXPECT_EQ(medial["wall"], "medial");
  EXPECT_NEAR(medial["thinnest"]["thickness_m"].get<double>(), 0.002, 0.0007);
  EXPECT_NEAR(medial["thinnest"]["inner_m"].get<double>(), 0.003, 0.0007);
  EXPECT_EQ(medial["depth_m"].size(), medial["thickness_m"].size());
  EXPECT_EQ(found["breach"]["wall"], "medial");
  EXPECT_LT(found["breach"]["tip_m"][0].get<double>(), 0.012) << "towards the midline";
}

TEST_F(CaseMaking, WhatIsWrongWithAPlanIsASentenceAndNoError) {
  const core::Json nowhere =
      look(plan({{"entry_m", {-0.037, 0.04, 0.02}}, {"target_m", {-0.037, 0.0, 0.02}}}));
  EXPECT_EQ(nowhere["tract"], nullptr);
  ASSERT_EQ(nowhere["problems"].size(), 1u);
  const core::Json outside =
      look(plan({{"entry_m", {1.0, 1.0, 1.0}}, {"target_m", {1.0, 0.96, 1.0}}}));
  EXPECT_NE(outside["problems"][0].get<std::string>().find("outside the volume"),
            std::string::npos);
  const core::Json deep = look(plan({{"breach", {{"wall", "medial"}, {"at_m", 0.5}}}}));
  EXPECT_NE(deep["tract"], nullptr) << "the tract is there, its breach is not";
  EXPECT_EQ(deep["breach"], nullptr);
  EXPECT_EQ(deep["problems"].size(), 1u);
  EXPECT_EQ(post("fay", "/volumes/released/tract", {{"entry_m", {0, 0}}}).status, 400);
}

TEST_F(CaseMaking, ABoneLeftWholeIsACaseToBeDrilled) {
  core::Json wish = plan({{"volume", "released"}, {"title", "To drill"}, {"channel", "planned"}});
  EXPECT_EQ(post("fay", "/cases", wish).status, 400) << "it has no breach";
  wish["breach"] = nullptr;
  const std::string id = made(wish);
  const auto facts = jobs::case_facts(store_, objects_, id);
  ASSERT_TRUE(facts) << facts.error().what;
  EXPECT_TRUE(facts->definition.planned);
  EXPECT_FALSE(facts->truth->breached);
  const core::Json listed = json(get("fay", "/cases"));
  for (const core::Json& one : listed["cases"]) EXPECT_EQ(one["planned"], one["id"] == id) << one;
  wish["channel"] = "square";
  EXPECT_EQ(post("fay", "/cases", wish).status, 400);
}

TEST_F(CaseMaking, ACaseIsMadeWhereThePlanSaidAndSignedByTheServer) {
  const core::Json told = look(plan());
  const std::string id = made(plan({{"volume", "released"}, {"title", "L3 left, medial"}}));
  ASSERT_EQ(id.size(), 64u);
  const auto facts = jobs::case_facts(store_, objects_, id);
  ASSERT_TRUE(facts) << facts.error().what;
  ASSERT_TRUE(facts->truth);
  EXPECT_EQ(facts->truth->breached, volume::Wall::medial);
  EXPECT_EQ(facts->truth->wall_thickness_m, told["breach"]["wall_thickness_m"].get<double>());
  EXPECT_EQ(facts->truth->breach_m->x(), told["breach"]["breach_m"][0].get<double>());
  const core::Json signature = *jobs::case_json_part(store_, objects_, id, "case.sig").value();
  EXPECT_NE(signature.dump().find(backend_.secrets.case_key().public_hex), std::string::npos);
  EXPECT_EQ(json(get("fay", "/cases"))["cases"].size(), 2u);
  EXPECT_EQ(
      ask(request("GET", "/api/v1/cases/" + id + "/parts/truth.json", station("token-1"))).status,
      403);
}

TEST_F(CaseMaking, APlanIsPalpatedBeforeACaseIsMadeOfIt) {
  const auto asked = [&](const char* who, const core::Json& more) {
    return post(who, "/volumes/released/certificate", plan(more));
  };
  const auto seen = asked("fay", {{"effort", "first"}, {"preparation", "filled"}});
  ASSERT_EQ(seen.status, 200) << text(seen);
  const core::Json found = json(seen);
  ASSERT_EQ(found["problem"], "");
  ASSERT_EQ(found["certificate"]["walls"].size(), 5u);
  EXPECT_EQ(found["certificate"]["walls"][0]["places"]["at_m"].size(), 1u);
  const auto nowhere = asked(
      "fay",
      {{"effort", "first"}, {"entry_m", {-0.037, 0.04, 0.02}}, {"target_m", {-0.037, 0.0, 0.02}}});
  EXPECT_EQ(json(nowhere)["certificate"], nullptr);
  EXPECT_NE(json(nowhere)["problem"], "");
  EXPECT_EQ(asked("fay", {{"effort", "some"}}).status, 400);
  EXPECT_EQ(asked("tom", {{"effort", "first"}}).status, 403);
}

/// Filled bone shows its envelope, also where it is refused, and takes a person's marks of it.
TEST_F(CaseMaking, AnEnvelopeIsShownAndMarked) {
  const auto wish = [](const core::Json& more) {
    core::Json out = plan({{"preparation", "filled"}, {"breach", nullptr}});
    out.update(more);
    return out;
  };
  EXPECT_EQ(look(plan({{"preparation", "published"}}))["envelope"], nullptr);
  const core::Json found = look(wish(core::Json::object()));
  ASSERT_EQ(found["problems"], core::Json::array());
  ASSERT_FALSE(found["calibration"].is_null());
  EXPECT_NEAR(found["calibration"]["cancellous_HU"].get<double>(), 60.0, 5.0);
  const auto farthest_x = [](const core::Json& tract) {
    double out = -1.0;
    for (const core::Json& p : tract["envelope"]["points_m"])
      if (std::abs(p[1].get<double>()) < 0.005) out = std::max(out, p[0].get<double>());
    return out;
  };
  const std::size_t around = found["envelope"]["around"].get<std::size_t>();
  EXPECT_EQ(found["envelope"]["points_m"].size() % around, 0u);
  EXPECT_NEAR(farthest_x(found), 0.022, 0.001) << "the pedicle's lateral face";

  const auto mark = [](double x, bool bone) {
    return core::Json{{"at_m", {x, 0.0, 0.0}}, {"radius_m", 0.003}, {"bone", bone}};
  };
  const core::Json marked = look(wish({{"envelope_marks", {mark(0.025, true)}}}));
  EXPECT_GT(farthest_x(marked), 0.0265) << "with what is said to be bone, and its far end";

  // Said to be no bone, right along the tract: refused, and yet shown.
  core::Json none = core::Json::array();
  for (const double y : {-0.006, -0.003, 0.0, 0.003, 0.006})
    none.push_back({{"at_m", {0.0182, y, 0.0}}, {"radius_m", 0.003}, {"bone", false}});
  const core::Json refused = look(wish({{"envelope_marks", none}}));
  EXPECT_FALSE(refused["problems"].empty());
  EXPECT_FALSE(refused["envelope"].is_null());

  const core::Json making =
      wish({{"volume", "released"}, {"title", "marked"}, {"envelope_marks", {mark(0.025, true)}}});
  EXPECT_FALSE(made(making).empty());
}

TEST_F(CaseMaking, AWrongMarkOfAnEnvelopeIsRefusedByName) {
  const auto status = [&](const core::Json& marks, const char* preparation) {
    return post("fay", "/volumes/released/tract",
                plan({{"preparation", preparation}, {"envelope_marks", marks}}));
  };
  const core::Json good{{"at_m", {0.0, 0.0, 0.0}}, {"radius_m", 0.003}, {"bone", true}};
  EXPECT_EQ(status({good}, "published").status, 400);
  EXPECT_EQ(status(core::Json::array(), "published").status, 200);
  for (const auto& [key, value] : {std::pair<const char*, core::Json>{"radius_m", 0.5},
                                   {"radius_m", "3"},
                                   {"bone", 1},
                                   {"at_m", {0.0, 0.0}},
                                   {"more", 1}}) {
    core::Json bad = good;
    bad[key] = value;
    const auto answer = status({good, bad}, "filled");
    EXPECT_EQ(answer.status, 400) << key;
    EXPECT_NE(text(answer).find("envelope_marks/1"), std::string::npos) << text(answer);
  }
  EXPECT_EQ(status(core::Json(201, good), "filled").status, 400);
  EXPECT_EQ(status("all", "filled").status, 400);
}

/// A case as it was made before there were certificates.
TEST_F(CaseMaking, AnOldCaseIsMarkedOnceItWasTried) {
  const std::string id = made(plan({{"volume", "released"}, {"title", "made"}}));
  const auto felt = [&](const std::string& of) {
    const core::Json listed = json(get("fay", "/cases"));
    for (const core::Json& one : listed["cases"])
      if (one["id"] == of) return one["felt"].get<std::string>();
    return std::string("absent");
  };
  const auto facts = jobs::case_facts(store_, objects_, id);
  EXPECT_EQ(felt(id), *facts->definition.certified ? "told" : "not_told");
  EXPECT_TRUE(facts->d_prime);

  const auto part =
      store_.read([&](store::Reading& tx) { return store::case_part(tx, id, cases::kVolumePart); });
  const auto drilled = volume::VolumeFile::open(objects_.path_of((*part)->sha256))->read_all();
  for (const bool breached : {true, false}) {
    cases::NewCase old{.definition = facts->definition,
                       .truth = breached ? *facts->truth : cases::Truth{},
                       .volume = *drilled,
                       .meta = {},
                       .draw = {}};
    old.definition.title = breached ? "old" : "old and whole";
    old.definition.certified.reset();
    const auto bundle = folder_.path() / (breached ? "old" : "whole");
    ASSERT_TRUE(cases::write_case(bundle, std::move(old), backend_.secrets.case_key()));
    const auto published = jobs::publish_bundle(store_, objects_, bundle);
    ASSERT_TRUE(published) << published.error().what;
    EXPECT_EQ(felt(*published), "untried");
    ASSERT_TRUE(jobs::certify_case(store_, objects_, *published));
    const auto tried = jobs::case_facts(store_, objects_, *published);
    EXPECT_EQ(tried->d_prime.has_value(), breached);
    EXPECT_EQ(get("fay", "/cases/" + *published + "/parts/certificate.json").status,
              breached ? 200 : 404);
    EXPECT_EQ(ask(request("GET", "/api/v1/cases/" + *published + "/parts/certificate.json",
                          station("token-1")))
                  .status,
              breached ? 403 : 404);
    if (breached)
      EXPECT_TRUE(felt(*published) == "told" || felt(*published) == "not_told");
    else
      EXPECT_EQ(felt(*published), "not_known");
  }
}

TEST_F(CaseMaking, AMakingThatFailsSaysWhyAndLeavesNoCase) {
  const auto asked = post("fay", "/cases",
                          plan({{"volume", "released"},
                                {"title", "far out"},
                                {"entry_m", {-0.037, 0.04, 0.02}},
                                {"target_m", {-0.037, 0.0, 0.02}}}));
  const std::string id = json(asked)["id"];
  const auto done =
      jobs::make_case(store_, objects_, backend_.secrets.case_key(), id, [] { return false; });
  ASSERT_FALSE(done);
  EXPECT_EQ(json(get("fay", "/cases"))["cases"].size(), 1u);
}

TEST_F(CaseMaking, AVolumeThatNobodyHasLookedAtIsNotUsed) {
  add_volume("held", store::VolumeState::held);
  EXPECT_EQ(post("fay", "/volumes/held/tract", plan()).status, 409);
  EXPECT_EQ(post("fay", "/cases", plan({{"volume", "held"}, {"title", "t"}})).status, 409);
  EXPECT_EQ(post("fay", "/cases", plan({{"volume", "none"}, {"title", "t"}})).status, 404);
  EXPECT_EQ(post("fay", "/cases", plan({{"volume", "released"}, {"title", " "}})).status, 400);
  EXPECT_EQ(post("rex", "/cases", plan({{"volume", "released"}, {"title", "t"}})).status, 403);
  EXPECT_EQ(post("tom", "/volumes/released/tract", plan()).status, 403);
}

}  // namespace
}  // namespace api
}  // namespace tractus
