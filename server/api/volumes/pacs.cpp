#include "server/api/volumes/pacs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/try.hpp"
#include "core/words.hpp"
#include "server/api/web_fetch.hpp"

namespace tractus {
namespace api {
namespace {

using core::bad_input;
using core::Errc;
using core::Error;
using core::Json;
using core::Result;
using QueryFields = std::vector<std::pair<std::string, std::string>>;

constexpr long kMaxOffset = 10'000;
constexpr std::size_t kMaxPatientId = 64, kMaxText = 200;  // PS3.5, table 6.2-1: LO has 64
constexpr const char* kDicomJson = "application/dicom+json";

std::string who(const PacsSettings& pacs) { return "the PACS at " + pacs.base; }

Fetch asked(const PacsSettings& pacs, std::string url, const char* accept) {
  Fetch out{.url = std::move(url),
            .headers = {std::string("Accept: ") + accept, "User-Agent: tractus-server"},
            .user = pacs.user,
            .password = pacs.password,
            .authority = pacs.authority,
            .patience = pacs.patience,
            .who = who(pacs)};
  if (!pacs.token.empty()) out.headers.push_back("Authorization: Bearer " + pacs.token);
  return out;
}

std::string advice(const PacsSettings& pacs, int status) {
  if (status == 401 || status == 403)
    return !pacs.token.empty()  ? ": check its token"
           : !pacs.user.empty() ? ": check its user and password"
                                : ": it wants a token or a user and password";
  if (status >= 300 && status < 400) return ": it sends elsewhere, where this server does not go";
  if (status == 404) return ": there is no such thing; check its address";
  return "";
}

Result<void> check_status(const PacsSettings& pacs, int status) {
  if (status == 200 || status == 204) return {};
  return Error{Errc::unavailable,
               fmt::format("{} answered {}{}", who(pacs), status, advice(pacs, status))};
}

/// What it answers to a query: an array of objects by tag (PS3.18, annex F).
Result<Json> queried(const PacsSettings& pacs, const std::string& path, const QueryFields& fields) {
  const auto answer = TRY(fetch(asked(pacs, with_query(pacs.base + path, fields), kDicomJson)));
  TRY(check_status(pacs, answer.status));
  if (answer.status == 204) return Json::array();
  const std::string type = http::media_type_of(answer.content_type).type;
  if (type != kDicomJson && type != "application/json")
    return bad_input(fmt::format("{} sent the type \"{}\": {} is expected", who(pacs),
                                 core::one_line(type, 60), kDicomJson));
  auto json = core::parse_json(answer.body, "the answer of " + who(pacs));
  if (!json) return json.error();
  if (!json->is_array()) return bad_input(who(pacs) + " sent no list");
  return json;
}

/// The values of an attribute; an empty array where there are none.
Json values_of(const Json& object, const char* tag) {
  const auto at = object.is_object() ? object.find(tag) : object.end();
  if (at == object.end() || !at->is_object()) return Json::array();
  const auto values = at->find("Value");
  return values != at->end() && values->is_array() ? *values : Json::array();
}

std::string text_of_value(const Json& value) {
  const std::string text = value.is_string() ? value.get<std::string>() : "";
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string::npos) return "";
  std::size_t size = text.find_last_not_of(' ') + 1 - first;
  if (size > kMaxText)  // at the end of a whole character of UTF-8
    for (size = kMaxText; size > 0 && (text[first + size] & 0xC0) == 0x80;) --size;
  return text.substr(first, size);
}

std::string text_in(const Json& object, const char* tag) {
  const Json values = values_of(object, tag);
  return values.empty() ? "" : text_of_value(values.front());
}

/// Numbers, also those that some servers write as texts; nothing where they are none.
std::optional<double> number_in(const Json& object, const char* tag, std::size_t place = 0) {
  const Json values = values_of(object, tag);
  if (place >= values.size()) return std::nullopt;
  if (values[place].is_number()) return values[place].get<double>();
  const std::string text = text_of_value(values[place]);
  double out = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), out);
  if (text.empty() || read.ec != std::errc{} || !std::isfinite(out)) return std::nullopt;
  return out;
}

std::optional<std::uint64_t> count_in(const Json& object, const char* tag) {
  const auto number = number_in(object, tag);
  if (!number || *number < 0.0 || *number > 1e9) return std::nullopt;
  return static_cast<std::uint64_t>(*number);
}

std::optional<double> metres_in(const Json& object, const char* tag, std::size_t place = 0) {
  const auto number_mm = number_in(object, tag, place);
  if (!number_mm || *number_mm <= 0.0) return std::nullopt;
  return *number_mm * 1e-3;
}

/// "20240314" is "2024-03-14"; another text is no date.
std::string day_of(const std::string& date) {
  if (date.size() != 8 || !std::ranges::all_of(date, [](char c) { return c >= '0' && c <= '9'; }))
    return "";
  return date.substr(0, 4) + "-" + date.substr(4, 2) + "-" + date.substr(6, 2);
}

PacsStudy study_from(const Json& object) {
  PacsStudy out{.uid = text_in(object, "0020000D"),
                .date = day_of(text_in(object, "00080020")),
                .description = text_in(object, "00081030"),
                .modalities = {},
                .series = count_in(object, "00201206"),
                .files = count_in(object, "00201208")};
  for (const Json& value : values_of(object, "00080061"))
    if (std::string text = text_of_value(value); !text.empty() && out.modalities.size() < 20)
      out.modalities.push_back(std::move(text));
  return out;
}

PacsSeries series_from(const Json& object) {
  return {.uid = text_in(object, "0020000E"),
          .modality = text_in(object, "00080060"),
          .description = text_in(object, "0008103E"),
          .number = count_in(object, "00200011"),
          .files = count_in(object, "00201209"),
          .row_spacing_m = metres_in(object, "00280030", 0),
          .column_spacing_m = metres_in(object, "00280030", 1),
          .thickness_m = metres_in(object, "00180050"),
          .slice_spacing_m = metres_in(object, "00180088")};
}

/// Those that have a UID by which they can be asked for, at most `most`.
template <class T>
std::vector<T> usable(const Json& list, T (*from)(const Json&), std::size_t most) {
  std::vector<T> out;
  for (const Json& one : list)
    if (T item = from(one); is_uid(item.uid) && out.size() < most) out.push_back(std::move(item));
  return out;
}

std::string dicom_date(const std::string& day) {
  std::string out = day;
  std::erase(out, '-');
  return out;
}

/// What matches a text that contains `part`: a wildcard stands for each character that an address
/// would have to encode, since some servers (Orthanc 1.10) take the code for the text.
std::string containing(const std::string& part) {
  std::string out = "*";
  for (const char c : part) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       c == '-' || c == '.' || c == '_' || c == '~';
    if ((c & 0xC0) != 0x80) out += plain ? c : '?';  // one for all bytes of a character of UTF-8
  }
  return out + "*";
}

/// "2024-03-14" or nothing.
std::string day_field(core::Fields& fields, const char* key) {
  const std::string day = fields.text_or(key, "", 10);
  if (!day.empty() && (dicom_date(day).size() != 8 || day_of(dicom_date(day)) != day))
    fields.wrong(key, "a day as 2024-03-14 is expected");
  return day;
}

/// Without what a query's matching gives a meaning (PS3.4, section C.2.2.2): wildcards and lists.
std::string plain_field(core::Fields& fields, const char* key, std::size_t limit) {
  const std::string text = fields.text_or(key, "", limit);
  if (std::ranges::any_of(text, [](char c) {
        return c == '*' || c == '?' || c == '\\' || c == ',' || (c >= 0 && c < 32);
      }))
    fields.wrong(key, "a text without * ? \\ , is expected");
  return text;
}

}  // namespace

Result<PacsSettings> read_pacs_settings(const std::filesystem::path& path) {
  const auto json = TRY(core::read_json(path));
  core::Fields fields(json, path.string());
  const std::string format = fields.text("format");
  if (!format.empty() && format != "tractus-pacs/1")
    fields.wrong("format", "tractus-pacs/1 is expected");
  PacsSettings out{.base = fields.text("base", 1000), .user = fields.text_or("user", "", 300)};
  const std::string password = fields.text_or("password_file", "");
  const std::string token = fields.text_or("token_file", "");
  out.authority = fields.text_or("authority", "");
  while (out.base.ends_with('/')) out.base.pop_back();
  if (!is_safe_address(out.base) || out.base.find_first_of("?# ") != std::string::npos)
    fields.wrong("base", "an https address without a query is expected");
  if (out.user.empty() != password.empty())
    fields.wrong("user", "user and password_file are expected together");
  if (!out.user.empty() && !token.empty())
    fields.wrong("token_file", "either a token or a user is expected");
  TRY(fields.done());
  if (!out.authority.empty()) out.authority = path.parent_path() / out.authority;
  if (!password.empty()) out.password = TRY(secret_in(path.parent_path() / password));
  if (!token.empty()) out.token = TRY(secret_in(path.parent_path() / token));
  return out;
}

StudySearch study_search_from(core::Fields& fields) {
  StudySearch out{.patient_id = plain_field(fields, "patient_id", kMaxPatientId),
                  .from = day_field(fields, "from"),
                  .to = day_field(fields, "to"),
                  .description = plain_field(fields, "description", kMaxPatientId),
                  .offset = fields.integer_or("offset", 0, 0, kMaxOffset)};
  if (out.patient_id.empty() && out.from.empty() && out.to.empty() && out.description.empty())
    fields.wrong("patient_id", "a patient's id, a day or a description is expected");
  return out;
}

bool is_uid(const std::string& text) {
  return !text.empty() && text.size() <= 64 &&
         text.find_first_not_of("0123456789.") == std::string::npos && text.front() != '.';
}

Result<std::vector<PacsStudy>> find_studies(const PacsSettings& pacs, const StudySearch& search) {
  QueryFields fields;
  if (!search.patient_id.empty()) fields.emplace_back("PatientID", search.patient_id);
  if (!search.from.empty() || !search.to.empty())
    fields.emplace_back("StudyDate", dicom_date(search.from) + "-" + dicom_date(search.to));
  for (const char* tag : {"00081030", "00080061", "00201206", "00201208"})
    fields.emplace_back("includefield", tag);
  fields.emplace_back("limit", std::to_string(kStudiesOfPage));
  fields.emplace_back("offset", std::to_string(search.offset));
  const std::string path = search.description.empty()
                               ? "/studies"
                               : "/studies?StudyDescription=" + containing(search.description);
  return usable(TRY(queried(pacs, path, fields)), study_from, kStudiesOfPage);
}

Result<std::vector<PacsSeries>> series_of(const PacsSettings& pacs, const std::string& study) {
  QueryFields fields;
  for (const char* tag : {"0008103E", "00200011", "00201209", "00280030", "00180050", "00180088"})
    fields.emplace_back("includefield", tag);
  fields.emplace_back("limit", std::to_string(kMostSeries));
  return usable(TRY(queried(pacs, "/studies/" + study + "/series", fields)), series_from,
                kMostSeries);
}

Result<FetchedSeries> fetch_series(const PacsSettings& pacs, const SeriesWish& wish) {
  Fetch what = asked(pacs, pacs.base + "/studies/" + wish.study_uid + "/series/" + wish.series_uid,
                     "multipart/related; type=\"application/dicom\"");
  std::unique_ptr<SeriesFiles> files;
  const auto so_far = [&files] {
    return files ? FetchedSeries{files->files(), files->bytes()} : FetchedSeries{};
  };
  what.patience = pacs.series_patience;
  what.silence = pacs.silence;
  what.take = [&](const Fetched& head, std::string_view piece) -> Result<void> {
    if (!files) files = TRY(SeriesFiles::make(head.content_type, wish.folder, who(pacs)));
    return files->take(piece);
  };
  what.may_go_on = [&] { return wish.may_go_on(so_far()); };
  const auto answer = TRY(fetch(what));
  TRY(check_status(pacs, answer.status));
  if (!files) return bad_input(who(pacs) + " sent no file");
  TRY(files->finish());
  return so_far();
}

}  // namespace api
}  // namespace tractus
