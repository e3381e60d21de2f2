"""Volume and surface area of irregular solids from slice photographs and scans."""
