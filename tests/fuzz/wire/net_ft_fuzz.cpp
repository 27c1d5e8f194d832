#include <cmath>
#include <stdexcept>

#include <kerf/drivers/protocols/net_ft.h>

#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

namespace net_ft = drivers::net_ft;

/// A datagram and a page, as they come: a record has its one size, a page that is taken says what a count is.
void fuzz_net_ft(Bytes bytes) {
  const auto record = net_ft::parse_record(bytes);
  promise(record.has_value() == (bytes.size() == net_ft::record_size), "a record has 36 bytes");
  if (record) {
    for (const auto box : {net_ft::Box::ati, net_ft::Box::onrobot}) {
      const bool sound = net_ft::health_of(box, record->status) == drivers::ForceHealth::sound;
      promise(sound || !net_ft::in_words(box, record->status).empty(), "what is wrong has words");
    }
  }
  (void)is_taken<std::invalid_argument>([&] {
    const net_ft::Page page = net_ft::parse_page(text_of(bytes));
    promise(std::isfinite(page.counts_per_n) && page.counts_per_n > 0.0 &&
                std::isfinite(page.counts_per_n_m) && page.counts_per_n_m > 0.0,
            "a page that is taken says what a count is");
    promise(!page.rate_hz || *page.rate_hz > 0.0, "a rate is above zero");
  });
}

const Registered registered("net_ft", fuzz_net_ft);

}  // namespace
}  // namespace kerf::fuzz
