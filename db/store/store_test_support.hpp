/// A folder of the test's own, and a connection whose n-th step fails.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "core/bytes.hpp"
#include "db/store/store.hpp"

namespace tractus::store::testing {

class TestFolder {
 public:
  TestFolder()
      : path_(std::filesystem::path(::testing::TempDir()) / ("tractus-" + core::new_id())) {
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Passes everything through but the `fails_at`-th step (from 1; 0 never): a begin, a statement or
/// a commit.
class FaultyConnection final : public Connection {
 public:
  FaultyConnection(std::unique_ptr<Connection> inner, const int& fails_at)
      : inner_(std::move(inner)), fails_at_(fails_at) {}
  core::Result<Rows> query(std::string_view sql, std::span<const Value> values) override {
    if (fails()) return broken();
    return inner_->query(sql, values);
  }
  core::Result<void> each(std::string_view sql, std::span<const Value> values,
                          const std::function<core::Result<void>(Row)>& seen) override {
    if (fails()) return broken();
    return inner_->each(sql, values, seen);
  }
  core::Result<void> script(std::string_view sql) override {
    if (fails()) return broken();
    return inner_->script(sql);
  }
  core::Result<std::vector<Table>> tables() override { return inner_->tables(); }
  core::Result<void> defer_references() override { return inner_->defer_references(); }
  core::Result<void> check_references() override { return inner_->check_references(); }
  core::Result<void> begin(Access access) override {
    if (fails()) return broken();
    return inner_->begin(access);
  }
  core::Result<void> commit() override {
    if (fails()) return broken();
    return inner_->commit();
  }
  void rollback() noexcept override { inner_->rollback(); }
  int steps() const { return step_; }

 private:
  bool fails() { return ++step_ == fails_at_; }
  static core::Error broken() { return {core::Errc::io, "made to fail"}; }
  std::unique_ptr<Connection> inner_;
  const int& fails_at_;
  int step_ = 0;
};

}  // namespace tractus::store::testing
