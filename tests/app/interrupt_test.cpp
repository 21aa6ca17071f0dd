#include "app/run/interrupt.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "evo/core/output_file.hpp"

namespace evo::app {
namespace {

namespace fs = std::filesystem;

class InterruptTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  fs::path folder = fs::temp_directory_path() / ("evo_interrupt_test_" + std::to_string(::getpid()));
};

TEST_F(InterruptTest, RemovesPartialFiles) {
  std::ofstream(folder / "earlier.txt") << "whole";
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const InterruptGuard guard(folder);
    OutputFile file(folder / "plots" / "half.txt");
    file.stream() << "half" << std::flush;
    ::kill(::getpid(), SIGINT);
    ::pause();
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGINT);
  EXPECT_TRUE(fs::exists(folder / "earlier.txt"));
  EXPECT_TRUE(fs::is_empty(folder / "plots"));
}

TEST_F(InterruptTest, EndsQuietlyAndRestoresTheSignalMask) {
  sigset_t before;
  sigset_t after;
  ::pthread_sigmask(SIG_BLOCK, nullptr, &before);
  { const InterruptGuard guard(folder); }
  ::pthread_sigmask(SIG_BLOCK, nullptr, &after);
  EXPECT_EQ(::sigismember(&before, SIGINT), ::sigismember(&after, SIGINT));
  EXPECT_EQ(::sigismember(&before, SIGTERM), ::sigismember(&after, SIGTERM));
}

}  // namespace
}  // namespace evo::app
