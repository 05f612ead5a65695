#include "core/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/file.hpp"

namespace core {

Result<Json> parse_json(std::string_view text, std::string_view name) {
  try {
    return Json::parse(text);
  } catch (const Json::exception& failure) {
    std::string why =
        failure.what();  // "[json.exception.parse_error.101] parse error at line 1, column 2: …"
    if (const auto end = why.find("] "); end != std::string::npos) why.erase(0, end + 2);
    return Error{Errc::bad_input, fmt::format("{}: not valid JSON: {}", name, why)};
  }
}

Result<Json> read_json(const std::filesystem::path& path) {
  auto bytes = read_file(path, 64u << 20);
  if (!bytes) return bytes.error();
  return parse_json(text_of(*bytes), path.string());
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
