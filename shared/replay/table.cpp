#include "replay/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/csv.hpp"
#include "replay/cells.hpp"

namespace tractus {
namespace replay {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double across(const math::Vec3& v) { return std::hypot(v.x(), v.y()); }

/// Three decimals and a sign for "less than that", as the source prints.
std::string short_number(double value, int decimals) {
  if (!std::isfinite(value)) return "–";
  const double least = std::pow(10.0, -decimals);
  return value < least ? fmt::format("<{:.{}f}", least, decimals)
                       : fmt::format("{:.{}f}", value, decimals);
}

/// At most 24 letters of a name, without splitting one.
std::string cut(const std::string& text) {
  std::string out;
  int letters = 0;
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0xC0) != 0x80 && ++letters > 24) return out + "…";
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out;
}

}  // namespace

const std::array<WrenchColumn, 4> kChannels{{
    {"force_xy_N", "F_xy", "N", 0.01, [](const math::Wrench& w) { return across(w.force_N); }},
    {"force_z_N", "F_z", "N", 0.01, [](const math::Wrench& w) { return w.force_N.z(); }},
    {"torque_xy_Nm", "T_xy", "N·m", 0.001,
     [](const math::Wrench& w) { return across(w.torque_Nm); }},
    {"torque_z_Nm", "T_z", "N·m", 0.001, [](const math::Wrench& w) { return w.torque_Nm.z(); }},
}};

Summary summary(std::span<const math::Wrench> wrenches, const WrenchColumn& channel) {
  Summary out{wrenches.size(), 0, kNone, kNone, kNone};
  double mean = 0.0, squares = 0.0, max = 0.0;  // Welford: no loss where the spread is small
  for (const auto& wrench : wrenches) {
    const double amount = std::abs(channel.signed_value(wrench));
    if (!(amount > channel.floor)) continue;
    const double step = amount - mean;
    mean += step / double(++out.above);
    squares += step * (amount - mean);
    max = std::max(max, amount);
  }
  if (out.above >= 1) out.mean = mean, out.max = max;
  if (out.above >= 2) out.sd = std::sqrt(squares / double(out.above - 1));
  return out;
}

Row row(std::string scope, std::string name, std::string source,
        std::span<const math::Wrench> wrenches) {
  Row out{std::move(scope), std::move(name), std::move(source), {}};
  for (std::size_t c = 0; c < kChannels.size(); ++c)
    out.channels[c] = summary(wrenches, kChannels[c]);
  return out;
}

std::string csv(std::span<const Row> rows) {
  std::string out = "scope,name,source,channel,samples,above_floor,mean,sd,max\n";
  for (const Row& row : rows)
    for (std::size_t c = 0; c < kChannels.size(); ++c) {
      const Summary& s = row.channels[c];
      out += fmt::format("{},{},{},{},{},{},{},{},{}\n", row.scope, core::csv_cell(row.name),
                         row.source, kChannels[c].id, s.samples, s.above, cell(s.mean), cell(s.sd),
                         cell(s.max));
    }
  return out;
}

std::string printed(std::span<const Row> rows) {
  std::string out = fmt::format("{:<26}{:<11}", "", "");
  for (const WrenchColumn& channel : kChannels)
    out += fmt::format("  {:<22}", fmt::format("{} [{}]", channel.label, channel.unit));
  out += fmt::format("\n{:<26}{:<11}", "", "");
  for (std::size_t c = 0; c < kChannels.size(); ++c)
    out += fmt::format("  {:>6} {:>6} {:>7} ", "mean", "sd", "max");
  out += "\n";
  for (const Row& row : rows) {
    out += fmt::format("{:<26}{:<11}", row.name.empty() ? row.scope : cut(row.name), row.source);
    for (std::size_t c = 0; c < kChannels.size(); ++c) {
      const Summary& s = row.channels[c];
      const int decimals = c < 2 ? 2 : 3;
      out += fmt::format("  {:>6} {:>6} {:>7} ", short_number(s.mean, decimals),
                         short_number(s.sd, decimals), short_number(s.max, decimals));
    }
    out += "\n";
  }
  return out + "Amounts over samples above 0.01 N and 0.001 N·m.\n";
}

core::Json to_json(const Row& row) {
  core::Json out{{"scope", row.scope}, {"name", row.name}, {"source", row.source}};
  for (std::size_t c = 0; c < kChannels.size(); ++c) {
    const Summary& s = row.channels[c];
    out["channels"].push_back({{"name", kChannels[c].id},
                               {"samples", s.samples},
                               {"above_floor", s.above},
                               {"mean", number(s.mean)},
                               {"sd", number(s.sd)},
                               {"max", number(s.max)}});
  }
  return out;
}

}  // namespace replay
}  // namespace tractus
