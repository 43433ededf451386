// What both versions of libgpiod say in words.
#include "board/linux/pedal/requested_lines.hpp"

#include "board/linux/byte_stream.hpp"

namespace orcart {

GpioTrouble gpio_trouble(const std::string& what, int error_number) {
  const PortFault fault = port_fault_of(error_number);
  std::string remedy;
  switch (fault) {
    case PortFault::disconnected:
      remedy = "; orcart probe lists the chips and lines there are";
      break;
    case PortFault::busy:
      remedy = "; end the program that holds it (orcart probe names it)";
      break;
    case PortFault::no_permission:
      remedy = "; a user in the group gpio would be let in";
      break;
    default:
      remedy = "; a line that can report edges, with a bias its chip can give, would be accepted";
  }
  return {fault, "the pedal's " + what + " cannot be had: " + std::string(word_for(fault)) + remedy};
}

}  // namespace orcart
