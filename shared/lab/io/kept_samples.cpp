#include "lab/io/kept_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>

#include "core/json.hpp"
#include "core/try.hpp"

namespace tractus {
namespace lab_io {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

static_assert(std::endian::native == std::endian::little, "the file is little endian");
constexpr std::string_view kMagic = "TLS1";
constexpr std::size_t kMostSamples = 1'000'000, kMostHeader_bytes = 4 << 20;

template <class T>
void append(std::string& out, const std::vector<T>& values) {
  out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

template <class T>
std::vector<T> thinned(const auto& from, std::size_t every) {
  std::vector<T> out;
  out.reserve(from.size() / every + 1);
  for (std::size_t k = 0; k < from.size(); k += every) out.push_back(T(from[k]));
  return out;
}

std::size_t total(const lab::Side& side) {
  std::size_t out = 0;
  for (const auto& trial : side.samples.trials) out += trial.t_s.size();
  return out;
}

Json header_of(const lab::Side& side, std::size_t every) {
  Json channels = Json::array(), trials = Json::array();
  for (const auto& channel : side.samples.channels)
    channels.push_back({{"name", channel.name}, {"noise_floor", channel.noise_floor}});
  for (const auto& trial : side.samples.trials)
    trials.push_back({{"id", trial.id}, {"samples", (trial.t_s.size() + every - 1) / every}});
  return {{"channels", channels},
          {"trials", trials},
          {"regions", side.comparison.error_regions.regions.size()}};
}

void append_side(std::string& out, const lab::Side& side, std::size_t every) {
  for (const auto& trial : side.samples.trials) {
    append(out, thinned<double>(trial.t_s, every));
    for (std::size_t c = 0; c < side.samples.channels.size(); ++c) {
      append(out, thinned<float>(trial.measured[c], every));
      append(out, thinned<float>(trial.simulated[c], every));
    }
    append(out, thinned<std::int8_t>(lab::regions_by_sample(side.samples, trial,
                                                            side.comparison.error_regions.regions),
                                     every));
  }
}

/// Where in the file the asked-for trial lies, and what its side is called.
struct Place {
  std::uint64_t at = 0, samples = 0;
  std::size_t channel = 0, channels = 0, regions = 0;
  double noise_floor = 0.0;
};

/// Bytes of one sample over all arrays.
std::uint64_t bytes_each(std::size_t channels) { return 8 + 8 * channels + 1; }

Result<Json> read_header(std::ifstream& file, const std::filesystem::path& path) {
  const Error broken{Errc::corrupt, path.filename().string() + ": not samples of the lab"};
  std::string magic(kMagic.size(), '\0');
  std::uint64_t size = 0;
  file.read(magic.data(), std::streamsize(magic.size()));
  file.read(reinterpret_cast<char*>(&size), sizeof size);
  if (!file || magic != kMagic || size > kMostHeader_bytes) return broken;
  std::string text(size, '\0');
  file.read(text.data(), std::streamsize(size));
  if (!file) return broken;
  return core::parse_json(text, "samples");
}

Result<Place> place_of(const Json& header, const SampleQuery& wish, std::uint64_t data_at) {
  const Json& sides = header["sides"];
  if (wish.after && sides.size() < 2)
    return Error{Errc::not_found, "side: there is no 'after' here, only 'before'"};
  Place out{.at = data_at};
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const bool asked = s == std::size_t(wish.after);
    out.channels = sides[s]["channels"].size();
    for (const Json& trial : sides[s]["trials"]) {
      out.samples = trial["samples"].get<std::uint64_t>();
      if (asked && trial["id"] == wish.trial) {
        const auto& channels = sides[s]["channels"];
        while (out.channel < out.channels && channels[out.channel]["name"] != wish.channel)
          ++out.channel;
        if (out.channel == out.channels)
          return Error{Errc::not_found, fmt::format("no channel '{}' here", wish.channel)};
        out.noise_floor = channels[out.channel]["noise_floor"].get<double>();
        out.regions = sides[s]["regions"].get<std::size_t>();
        return out;
      }
      out.at += out.samples * bytes_each(out.channels);
    }
  }
  return Error{Errc::not_found, fmt::format("no trial '{}' here", wish.trial)};
}

template <class T>
bool read_array(std::ifstream& file, std::uint64_t at, std::vector<T>& out) {
  file.seekg(std::streamoff(at));
  file.read(reinterpret_cast<char*>(out.data()), std::streamsize(out.size() * sizeof(T)));
  return bool(file);
}

void add_point(Envelope& to, const std::vector<float>& values, std::size_t from, std::size_t end) {
  const auto [least, most] = std::minmax_element(values.begin() + std::ptrdiff_t(from),
                                                 values.begin() + std::ptrdiff_t(end));
  to.least.push_back(double(*least));
  to.most.push_back(double(*most));
}

void add_regions(SampleView& view, const std::vector<double>& t_s,
                 const std::vector<std::int8_t>& region, std::size_t from, std::size_t end,
                 double join_s) {
  for (std::size_t k = from; k < end; ++k) {
    if (region[k] < 0 || std::size_t(region[k]) >= view.regions.size()) continue;
    auto& spans = view.regions[std::size_t(region[k])];
    const double until = k + 1 < end ? t_s[k + 1] : t_s[k];
    if (!spans.empty() && t_s[k] - spans.back().second <= join_s)
      spans.back().second = until;
    else
      spans.emplace_back(t_s[k], until);
  }
}

}  // namespace

std::string kept_samples(const lab::Side& before, const lab::Side* after) {
  const std::size_t every = 1 + total(before) / kMostSamples;
  Json header{{"every", every}, {"sides", Json::array({header_of(before, every)})}};
  if (after) header["sides"].push_back(header_of(*after, every));
  const std::string text = header.dump();
  const std::uint64_t size = text.size();
  std::string out(kMagic);
  out.append(reinterpret_cast<const char*>(&size), sizeof size);
  out += text;
  append_side(out, before, every);
  if (after) append_side(out, *after, every);
  return out;
}

Result<SampleView> view_samples(const std::filesystem::path& path, const SampleQuery& wish) {
  std::ifstream file(path, std::ios::binary);
  const auto header = TRY(read_header(file, path));
  const auto place = TRY(place_of(header, wish, std::uint64_t(file.tellg())));
  const std::uint64_t n = place.samples;
  std::vector<double> t_s(n);
  std::vector<float> measured(n), simulated(n);
  std::vector<std::int8_t> region(n);
  const std::uint64_t channel_at = place.at + 8 * n + 8 * n * place.channel;
  if (!read_array(file, place.at, t_s) || !read_array(file, channel_at, measured) ||
      !read_array(file, channel_at + 4 * n, simulated) ||
      !read_array(file, place.at + 8 * n + 8 * n * place.channels, region))
    return Error{Errc::corrupt, path.filename().string() + ": ends too early"};
  SampleView view;
  view.noise_floor = place.noise_floor;
  view.regions.resize(place.regions);
  if (n == 0) return view;
  const double start = t_s.front();
  for (double& t : t_s) t -= start;
  view.duration_s = t_s.back();
  const auto first = std::size_t(std::ranges::lower_bound(t_s, wish.from_s) - t_s.begin());
  const auto end = std::size_t(std::ranges::upper_bound(t_s, wish.to_s) - t_s.begin());
  if (first >= end) return view;
  const std::size_t per = (end - first + wish.points - 1) / std::max<std::size_t>(1, wish.points);
  view.samples_per_point = per * header["every"].get<std::uint64_t>();
  std::vector<float> residual(n);
  for (std::size_t k = first; k < end; ++k) residual[k] = measured[k] - simulated[k];
  for (std::size_t k = first; k < end; k += per) {
    const std::size_t to = std::min(end, k + per);
    view.t_s.push_back(t_s[k]);
    add_point(view.measured, measured, k, to);
    add_point(view.simulated, simulated, k, to);
    add_point(view.residual, residual, k, to);
  }
  const double join_s = (t_s[end - 1] - t_s[first]) / double(std::max<std::size_t>(1, wish.points));
  add_regions(view, t_s, region, first, end, join_s);
  return view;
}

}  // namespace lab_io
}  // namespace tractus
