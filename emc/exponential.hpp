#pragma once

// The exponential function with the same bits on every machine: the C library's may differ from one to the
// next, and with it the picosecond at which a receiver goes wrong.
namespace fieldproof::emc {

// e^x to a few units in the last place; 0 below -700, x at most 700.
double portable_exp(double x);

// x^y for x > 0.
double portable_power(double x, double y);

// The factor by which an attenuation of so many decibel reduces a voltage: 20 dB gives 0.1.
double voltage_factor(double attenuation_db);

}  // namespace fieldproof::emc
