#include "tests/bench/ingest/postgres_copy.hpp"

#include <endian.h>
#include <libpq-fe.h>

#include <bit>
#include <cstdlib>
#include <cstring>

namespace tractus {
namespace bench {
namespace {

/// COPY's binary form (PostgreSQL's manual, COPY, "Binary Format").
class Tuples {
 public:
  Tuples() { text_.assign("PGCOPY\n\377\r\n\0", 11), text_.append(8, '\0'); }
  void begin(std::int16_t columns) { put(htobe16(static_cast<std::uint16_t>(columns))); }
  void real(double value) { field(htobe64(std::bit_cast<std::uint64_t>(value))); }
  void real(float value) { field(htobe32(std::bit_cast<std::uint32_t>(value))); }
  void whole(std::uint32_t value) { field(htobe32(value)); }
  const std::string& finished() { return begin(-1), text_; }

 private:
  template <class T>
  void put(T value) {
    text_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class T>
  void field(T value) {
    put(htobe32(static_cast<std::uint32_t>(sizeof value)));
    put(value);
  }
  std::string text_;
};

void add_row(Tuples& out, const trial::Sample& s) {
  out.begin(24);
  out.real(s.t_s);
  for (double v : s.p_VH_m) out.real(v);
  for (double v : s.q_VH) out.real(v);
  for (const auto* triple : {&s.force_N, &s.torque_Nm, &s.rendered_force_N, &s.rendered_torque_Nm})
    for (float v : *triple) out.real(v);
  for (float v : s.deflection_m) out.real(v);
  out.whole(s.tick);
  out.whole(std::uint32_t{s.iterations} << 16 | s.flags);
}

}  // namespace

struct PostgresCopy::Connection {
  PGconn* raw = nullptr;
  ~Connection() { PQfinish(raw); }
  bool run(const char* sql, ExecStatusType expected) const {
    PGresult* result = PQexec(raw, sql);
    const bool fine = PQresultStatus(result) == expected;
    PQclear(result);
    return fine;
  }
};

PostgresCopy::PostgresCopy(const std::string& address)
    : connection_(std::make_unique<Connection>()) {
  connection_->raw = PQconnectdb(address.c_str());
  std::string columns = "t double precision";
  for (int i = 0; i < 7; ++i) columns += ", d" + std::to_string(i) + " double precision";
  for (int i = 0; i < 14; ++i) columns += ", f" + std::to_string(i) + " real";
  const std::string table = "create table samples (" + columns + ", tick integer, bits integer)";
  if (!connection_->run(table.c_str(), PGRES_COMMAND_OK)) std::abort();
}

PostgresCopy::~PostgresCopy() = default;

bool PostgresCopy::add(std::span<const trial::Sample> batch) {
  Tuples tuples;
  for (const trial::Sample& sample : batch) add_row(tuples, sample);
  const std::string& data = tuples.finished();
  if (!connection_->run("copy samples from stdin (format binary)", PGRES_COPY_IN)) return false;
  if (PQputCopyData(connection_->raw, data.data(), static_cast<int>(data.size())) != 1 ||
      PQputCopyEnd(connection_->raw, nullptr) != 1)
    return false;
  bool fine = true;
  while (PGresult* result = PQgetResult(connection_->raw)) {
    fine = fine && PQresultStatus(result) == PGRES_COMMAND_OK;
    PQclear(result);
  }
  return fine;
}

long PostgresCopy::rows() const {
  PGresult* result = PQexec(connection_->raw, "select count(*) from samples");
  const long count = PQntuples(result) == 1 ? std::atol(PQgetvalue(result, 0, 0)) : -1;
  PQclear(result);
  return count;
}

}  // namespace bench
}  // namespace tractus
