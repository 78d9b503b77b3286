#include "protocols/interbus/paper.hpp"

namespace fieldproof::interbus {

NetworkDescription paper_network() {
  NetworkDescription network;
  network.name = "Park 2004: RFC 430 ETH with IB IL 24 DI 16 and IB IL 24 DO 16";
  network.formula = Formula::f4;
  StationDescription coupler{.name = "coupler", .id_code = 0x0008};
  coupler.branch = {{.name = "di16", .id_code = 0x01BE, .is_local = true},
                    {.name = "do16", .id_code = 0x01BD, .is_local = true}};
  network.stations = {coupler};
  network.copy = {{.from = "di16", .input_word = 0, .to = "do16", .output_word = 0}};
  return network;
}

NetworkDescription paper_network_as_printed() {
  NetworkDescription network = paper_network();
  network.name = "Park 2004 as printed: 8 + n telegrams";
  network.formula = Formula::f1;
  network.rules.end_telegrams = 2;
  return network;
}

}  // namespace fieldproof::interbus
