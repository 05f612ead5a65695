#include "core/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/file.hpp"
#include "core/try.hpp"
#include "core/words.hpp"

namespace tractus {
namespace core {

namespace {

/// Builds the document while nlohmann's lexer reads it, and stops at the first thing refused.
class Builder final : public nlohmann::json_sax<Json> {
 public:
  explicit Builder(const JsonLimits& limits) : limits_(limits) {}

  bool null() override { return add(nullptr) != nullptr; }
  bool boolean(bool value) override { return add(value) != nullptr; }
  bool number_integer(number_integer_t value) override { return add(value) != nullptr; }
  bool number_unsigned(number_unsigned_t value) override { return add(value) != nullptr; }
  bool number_float(number_float_t value, const string_t& text) override {
    if (text.size() > limits_.number_characters)
      return refuse(fmt::format("a number of {} characters, at most {} are read", text.size(),
                                limits_.number_characters));
    return add(value) != nullptr;
  }
  bool string(string_t& value) override { return add(std::move(value)) != nullptr; }
  bool binary(binary_t&) override { return refuse("binary data"); }  // no part of JSON's text
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool end_array() override { return close(); }
  bool end_object() override { return has_distinct_names() && close(); }
  bool key(string_t& name) override {
    name_ = std::move(name);
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const Json::exception& failure) override {
    std::string_view why = failure.what();  // "[json.exception.parse_error.101] parse error at …"
    if (const auto end = why.find("] "); end != why.npos) why.remove_prefix(end + 2);
    return refuse(why);
  }

  Json& document() { return document_; }
  const std::string& error() const { return error_; }

 private:
  bool refuse(std::string_view why) {
    error_ = one_line(why, 300);
    return false;
  }
  /// Where the value now stands; null when there is no room for it.
  Json* add(Json value) {
    if (++values_ > limits_.values)
      return refuse(fmt::format("more than {} values", limits_.values)), nullptr;
    if (open_.empty()) return document_ = std::move(value), &document_;
    if (auto* array = open_.back()->get_ptr<Json::array_t*>())
      return &array->emplace_back(std::move(value));
    // Not operator[], which compares the name with every other: end_object finds duplicates.
    std::vector<Json::object_t::value_type>& members = open_.back()->get_ref<Json::object_t&>();
    if (members.size() == limits_.members)
      return refuse(fmt::format("an object of more than {} members", limits_.members)), nullptr;
    return &members.emplace_back(std::move(name_), std::move(value)).second;
  }
  bool open(Json empty) {
    if (open_.size() == limits_.depth)
      return refuse(fmt::format("nested deeper than {} levels", limits_.depth));
    Json* const at = add(std::move(empty));
    if (at) open_.push_back(at);
    return at != nullptr;
  }
  bool close() {
    open_.pop_back();
    return true;
  }
  bool has_distinct_names() {
    std::vector<std::string_view> names;
    for (const auto& [name, value] : open_.back()->get_ref<const Json::object_t&>())
      names.push_back(name);
    std::ranges::sort(names);
    const auto twice = std::ranges::adjacent_find(names);
    if (twice == names.end()) return true;
    return refuse(fmt::format("the name \"{}\" stands twice in one object", one_line(*twice, 80)));
  }

  JsonLimits limits_;
  std::size_t values_ = 0;
  Json document_;
  std::vector<Json*> open_;  ///< objects and arrays not yet closed, the innermost last
  std::string name_;         ///< of the member that comes next
  std::string error_;
};

}  // namespace

Result<Json> parse_json(std::string_view text, std::string_view name, const JsonLimits& limits) {
  Builder builder(limits);
  if (!Json::sax_parse(text, &builder))
    return Error{Errc::bad_input, fmt::format("{}: not valid JSON: {}", name, builder.error())};
  return std::move(builder.document());
}

Json stored_json(std::string_view text) {
  auto json = parse_json(text, "", kStoredJson);
  return json ? std::move(*json) : Json();
}

Result<Json> read_json(const std::filesystem::path& path) {
  auto bytes = TRY(read_file(path, 64u << 20));
  return parse_json(text_of(bytes), path.string());
}

Result<void> write_json(const std::filesystem::path& path, const Json& json) {
  return write_file(path, bytes_of(json.dump(2) + "\n"));
}

Fields::Fields(const Json& object, std::string where) : object_(object), where_(std::move(where)) {
  if (!object_.is_object()) first_error_ = fmt::format("{}: a JSON object is expected", where_);
}

const Json* Fields::find(const char* key) {
  seen_.emplace_back(key);
  if (!object_.is_object()) return nullptr;
  const auto it = object_.find(key);
  return it == object_.end() ? nullptr : &*it;
}

bool Fields::has(const char* key) const { return object_.is_object() && object_.contains(key); }

void Fields::skip(const char* key) { seen_.emplace_back(key); }

void Fields::wrong(const char* key, std::string why) {
  if (first_error_.empty()) first_error_ = fmt::format("{}/{}: {}", where_, key, why);
}

void Fields::unknown_word(const char* key, const std::string& given, const std::string& allowed) {
  wrong(key, fmt::format("'{}' is none of {}", one_line(given), allowed));
}

const Json* Fields::member(const char* key, bool needed) {
  const Json* found = find(key);
  if (!found && needed) wrong(key, "is missing");
  return found;
}

double Fields::number(const char* key, double low, double high) {
  const Json* found = member(key);
  if (!found) return low;
  if (!found->is_number()) return wrong(key, "a number is expected"), low;
  const double value = found->get<double>();
  if (!(value >= low && value <= high))
    return wrong(key, fmt::format("{} is outside {} … {}", value, low, high)), low;
  return value;
}

double Fields::number_or(const char* key, double fallback, double low, double high) {
  return has(key) ? number(key, low, high) : (skip(key), fallback);
}

long Fields::integer(const char* key, long low, long high) {
  const Json* found = member(key);
  if (!found) return low;
  if (!found->is_number_integer()) return wrong(key, "a whole number is expected"), low;
  if (found->is_number_unsigned() && found->get<std::uint64_t>() > std::uint64_t(INT64_MAX))
    return wrong(key, fmt::format("is outside {} … {}", low, high)), low;
  const long value = found->get<long>();
  if (value < low || value > high)
    return wrong(key, fmt::format("{} is outside {} … {}", value, low, high)), low;
  return value;
}

long Fields::integer_or(const char* key, long fallback, long low, long high) {
  return has(key) ? integer(key, low, high) : (skip(key), fallback);
}

std::string Fields::text(const char* key, std::size_t limit) {
  const Json* found = member(key);
  if (!found) return {};
  if (!found->is_string()) return wrong(key, "a text is expected"), std::string();
  auto value = found->get<std::string>();
  if (value.size() > limit)
    return wrong(key, fmt::format("{} characters, at most {} are taken", value.size(), limit)),
           std::string();
  return value;
}

std::string Fields::text_or(const char* key, std::string fallback, std::size_t limit) {
  return has(key) ? text(key, limit) : (skip(key), fallback);
}

std::vector<double> Fields::numbers(const char* key, std::size_t size) {
  std::vector<double> out(size, 0.0);
  const Json* found = member(key);
  if (!found) return out;
  const bool shaped = found->is_array() && found->size() == size &&
                      std::ranges::all_of(*found, [](const Json& v) { return v.is_number(); });
  if (!shaped) return wrong(key, fmt::format("an array of {} numbers is expected", size)), out;
  for (std::size_t i = 0; i < size; ++i) {
    out[i] = (*found)[i].get<double>();
    if (!std::isfinite(out[i])) wrong(key, "a finite number is expected");
  }
  return out;
}

Result<void> Fields::done() const {
  if (!first_error_.empty()) return Error{Errc::bad_input, first_error_};
  for (const auto& [key, value] : object_.items())
    if (std::ranges::find(seen_, key) == seen_.end())
      return Error{Errc::bad_input, fmt::format("{}/{}: this field is not known", where_, key)};
  return {};
}

}  // namespace core
}  // namespace tractus
