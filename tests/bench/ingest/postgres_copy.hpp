/// The rival: the same samples as rows of a PostgreSQL table, by COPY in binary.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "trial/trial.hpp"

namespace tractus::bench {

/// One connection, one table of 24 columns (t_s and the pose in double precision, what is float in
/// a sample in real). Every batch is a transaction, on the disk when it returns.
class PostgresCopy {
 public:
  explicit PostgresCopy(const std::string& address);
  ~PostgresCopy();
  PostgresCopy(const PostgresCopy&) = delete;
  PostgresCopy& operator=(const PostgresCopy&) = delete;
  bool add(std::span<const trial::Sample> batch);
  long rows() const;

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace tractus::bench
