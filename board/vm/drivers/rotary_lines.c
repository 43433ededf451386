// SPDX-License-Identifier: MIT OR GPL-2.0
// A rotary encoder between lines 6 and 7 of gpio-sim's chip "cart", told to the kernel's own driver rotary-encoder as a
// cart's device tree tells it: four counts a period of its Gray code, on a relative axis.
#include <linux/gpio/machine.h>
#include <linux/input.h>
#include <linux/module.h>
#include <linux/platform_device.h>
#include <linux/property.h>

static struct gpiod_lookup_table lines = {
	.dev_id = "rotary-encoder",
	.table = {
		GPIO_LOOKUP_IDX("cart", 6, NULL, 0, GPIO_ACTIVE_HIGH),
		GPIO_LOOKUP_IDX("cart", 7, NULL, 1, GPIO_ACTIVE_HIGH),
		{},
	},
};

static const struct property_entry properties[] = {
	PROPERTY_ENTRY_U32("rotary-encoder,steps-per-period", 4),
	PROPERTY_ENTRY_BOOL("rotary-encoder,relative-axis"),
	PROPERTY_ENTRY_U32("linux,axis", REL_DIAL),
	{},
};

static struct platform_device *encoder;

static int __init rotary_lines_init(void)
{
	const struct platform_device_info info = {
		.name = "rotary-encoder",
		.id = PLATFORM_DEVID_NONE,
		.properties = properties,
	};

	gpiod_add_lookup_table(&lines);
	encoder = platform_device_register_full(&info);
	if (!IS_ERR(encoder))
		return 0;
	gpiod_remove_lookup_table(&lines);
	return PTR_ERR(encoder);
}
module_init(rotary_lines_init);

static void __exit rotary_lines_exit(void)
{
	platform_device_unregister(encoder);
	gpiod_remove_lookup_table(&lines);
}
module_exit(rotary_lines_exit);

MODULE_DESCRIPTION("A rotary encoder on simulated lines");
MODULE_LICENSE("Dual MIT/GPL");
