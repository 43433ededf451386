// orcartd: the resident program of the cart.
#include "firmware-host/app/run.hpp"

int main(int argc, char** argv) {
  const auto options = orcart::read_options(argc, argv);
  if (!options) return options.error();
  return static_cast<int>(orcart::run(*options));
}
