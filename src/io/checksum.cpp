#include "evo/io/checksum.hpp"

#include <openssl/evp.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "io/byte_source.hpp"

namespace evo::io {

namespace {

constexpr std::size_t kBufferBytes = std::size_t{256} << 10;

struct FreeContext {
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};

}  // namespace

std::string Sha256(const std::filesystem::path& path, const std::stop_token& stop) {
  const ByteSource file(path);
  const std::unique_ptr<EVP_MD_CTX, FreeContext> context(EVP_MD_CTX_new());
  std::vector<char> buffer(kBufferBytes);
  bool good = context && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1;
  std::int64_t offset = 0;
  for (std::size_t got = 0; good && (got = file.Read(offset, buffer.size(), buffer.data())) > 0;) {
    good = EVP_DigestUpdate(context.get(), buffer.data(), got) == 1;
    offset += static_cast<std::int64_t>(got);
    if (stop.stop_requested()) return {};
  }
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  good = good && EVP_DigestFinal_ex(context.get(), digest.data(), &size) == 1;
  if (!good) throw Error(ErrorKind::kInput, path.string() + ": libcrypto offers no SHA-256 for its checksum");
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (unsigned i = 0; i < size; ++i) {
    text += kDigits[digest[i] >> 4];
    text += kDigits[digest[i] & 15];
  }
  return text;
}

}  // namespace evo::io
